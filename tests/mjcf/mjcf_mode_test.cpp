// The caller's floating-point mode changes nothing in what MJCF becomes.
#include <catch2/catch.hpp>

#include "manyworlds/mjcf.hpp"
#include "tests/support/float_modes.hpp"

namespace manyworlds::test {

TEST_CASE("the caller's floating-point mode changes no bit of an MJCF scene", "[mjcf][mode]") {
  const std::string xml = R"(<mujoco><option gravity="0 0.1 -9.81"/><worldbody>
    <geom type="plane" size="1 1 1"/>
    <body pos="0.1 0.2 0.3" euler="10 20 30"><freejoint/>
      <geom type="box" size="0.1 0.2 0.33"/><geom type="sphere" pos="0.3 0 0" size="0.1"/></body>
    </worldbody></mujoco>)";
  check_modes({{"load_mjcf_string", [&](const InMode& in_mode) {
                  MjcfResult result;
                  in_mode([&] { result = load_mjcf_string(xml); });
                  StateBytes out;
                  for (const Body& body : result.scene.bodies) {
                    out.add(body.position);
                    out.add(body.rotation.coeffs());
                    if (!body.mass_properties) continue;
                    out.add(body.mass_properties->mass);
                    out.add(body.mass_properties->inertia);
                  }
                  out.add(*result.scene.options.length_unit);
                  return out;
                }}});
}

}  // namespace manyworlds::test
