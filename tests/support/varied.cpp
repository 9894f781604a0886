#include "tests/support/varied.hpp"

namespace manyworlds::test {

Scene varied_crowd(Space space, bool polygons) {
  Scene scene = capsule_crowd(space, polygons);
  Body two = body_of(shape_of(cube_of(space, 0.25)), Vec3(0.3, 0, 0) + 4 * up_of(space));
  two.shapes.push_back(shape_of(round_of(space, 0.3)));
  two.shapes[1].position = Vec3(0.4, 0.1, 0);
  two.jitter.angle = 1;
  scene.add(two);
  Variation size;
  size.parameter = Parameter::size;
  size.low.setConstant(0.15), size.high.setConstant(0.45);
  scene.variations = {size,
                      vary(Parameter::density, 200, 2000, Draw::log_uniform),
                      vary(Parameter::friction, 0.1, 0.9),
                      vary(Parameter::restitution, 0, 0.6),
                      vary(Parameter::rolling_resistance, 0, 0.05),
                      gravity_between(-11 * up_of(space), -9 * up_of(space)),
                      vary(Parameter::gravity_scale, 0.8, 1.2),
                      vary(Parameter::linear_drag, 0, 0.3),
                      vary(Parameter::angular_drag, 0, 0.3)};
  if (space == Space::spatial) {
    scene.variations.push_back(vary(Parameter::torsional_resistance, 0, 0.05));
  }
  for (int body : {2, 5}) {
    Variation mass = vary(Parameter::mass, 50, 500);
    mass.body = BodyId(body);
    scene.variations.push_back(mass);
  }
  return scene;
}

}  // namespace manyworlds::test
