// Changes in a JSON text, most of which leave it JSON.
#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <string>

namespace manyworlds::fuzz {

std::string edit_json(const std::string& text, FuzzedDataProvider& in);

}  // namespace manyworlds::fuzz
