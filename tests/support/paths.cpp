#include "tests/support/paths.hpp"

namespace manyworlds::test {

const char* const kSourceFolder = MW_SOURCE_DIR;
#if MW_HAVE_CLI
const char* const kProgram = MW_CLI_PATH;
const char* const kFailingThreads = MW_FAILING_THREADS;
#endif

}  // namespace manyworlds::test
