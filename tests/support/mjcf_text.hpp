// MJCF as text.
#pragma once

#include <string>

namespace manyworlds::test {

// A model whose worldbody has this content.
inline std::string world(const std::string& content, const std::string& before = "") {
  return "<mujoco>" + before + "<worldbody>" + content + "</worldbody></mujoco>";
}

}  // namespace manyworlds::test
