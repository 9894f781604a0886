// What is wrong with a command line, for people.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace manyworlds::cli {

// One line, and where help is unless the message already says it all.
std::string describe(const CLI::ParseError& error, const CLI::App& app);

}  // namespace manyworlds::cli
