// MuJoCo's own model and data of an MJCF text, to compare ours with.
#pragma once

#include <string>

#include <mujoco/mujoco.h>
#include <catch2/catch.hpp>

#include "src/mjcf/mujoco_library.hpp"

namespace manyworlds::test {

// Posed as it begins.
struct Reference {
  mjcf::ModelPtr model;
  mjcf::DataPtr data;

  explicit Reference(const std::string& xml) {
    char error[1000] = "";
    const mjcf::SpecPtr spec(mj_parseXMLString(xml.c_str(), nullptr, error, sizeof error));
    INFO(error);
    REQUIRE(spec);
    model.reset(mj_compile(spec.get(), nullptr));
    REQUIRE(model);
    data.reset(mj_makeData(model.get()));
    mj_forward(model.get(), data.get());
  }
};

}  // namespace manyworlds::test
