// Paths of this checkout and of its program. They are defined in one file, so that a checkout at
// another place compiles the tests to the same objects.
#pragma once

namespace manyworlds::test {

extern const char* const kSourceFolder;
#if MW_HAVE_CLI
extern const char* const kProgram;
extern const char* const kFailingThreads;  // tests/preload, for LD_PRELOAD
#endif

}  // namespace manyworlds::test
