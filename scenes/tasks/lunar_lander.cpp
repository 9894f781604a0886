// LunarLander after Gymnasium's LunarLander-v3: its bodies, joints and engines, its start, rewards
// and ends, so that a policy of one controls the other. Lengths there are pixels, 30 to a metre.
//
// Not as there: its engines sputter (each step's thrust is off by chance, by up to a half), here
// they do not. Beside the pad, the ground there has four slopes on either side, here one. And a leg
// there forgets that it stands when it slides from one piece of ground to the next, here it does
// not: since its heuristic steers in flight alone, slopes here fall by no more than friction holds.
#include "scenes/tasks/makers.hpp"

namespace manyworlds::tasks {
namespace {

constexpr double kPixel = 1.0 / 30;                // m
constexpr double kWidth = 10, kHeight = 20.0 / 3;  // m, half of the view: units of x and y
constexpr double kDt = 0.02;                       // s
constexpr double kSpeedX = 5, kSpeedY = 7.5;       // m/s, units of the velocities
constexpr double kSpinUnit = 2.5;                  // rad/s, unit of the angular velocity
constexpr double kPad = 2;                         // m, half the pad's width
constexpr double kStart = 10.033;                  // m over the pad
constexpr double kMaxForce = 1000;                 // N for one step, either way, along x and y
constexpr double kFolded = 0.9, kSpread = 0.4;     // rad, of a leg against the cabin
// The engines are impulses there, N s in a step; here forces with the same effect.
constexpr double kMainThrust = 13 * 4 * kPixel / kDt, kSideThrust = 0.6 * 12 * kPixel / kDt;  // N
// Box2D's rest: all bodies slower than this for half a second.
constexpr double kSlow = 0.01, kSlowTurn = 0.0349;  // m/s, rad/s
constexpr int kRest = 25;                           // steps
constexpr std::uint32_t kGround = 1, kLander = 2;   // Filter::category

struct Craft {
  Scene scene;
  BodyId cabin, left, right;
};

// Solid below a level stretch from x = low to high, m, in the body frame.
Shape slab(double low, double high) {
  constexpr double kDepth = 4;  // m
  Shape shape = shape_of(Polygon{{{low, -kDepth}, {high, -kDepth}, {high, 0}, {low, 0}}});
  shape.material.friction = 0.1;
  shape.filter.category = kGround;
  return shape;
}

void add_ground(Scene& scene) {
  constexpr double kLength = 12;  // m, of a slope
  constexpr double kRise = 0.1;   // rad, on average
  Body pad;
  pad.name = "pad";
  pad.motion = Motion::fixed;
  pad.shapes = {slab(-kPad, kPad)};
  scene.add(pad);
  for (const double side : {-1.0, 1.0}) {
    Body slope;  // turns about the pad's end
    slope.name = side < 0 ? "left slope" : "right slope";
    slope.motion = Motion::kinematic;
    slope.position = {side * kPad, 0, 0};
    slope.rotation = Eigen::AngleAxisd(side * kRise, Vec3::UnitZ());
    slope.jitter.angle = 0.25;
    slope.shapes = {side < 0 ? slab(-kLength, 0) : slab(0, kLength)};
    scene.add(slope);
  }
}

// A leg on a hinge in the middle of the cabin, spread by a motor that gives way to hard landings.
BodyId add_leg(Scene& scene, BodyId cabin, double side) {
  constexpr double kAway = 20 * kPixel, kDown = 18 * kPixel;  // m, from the hinge
  const double spread = side * kSpread;
  const Eigen::AngleAxisd spread_rotation(spread, Vec3::UnitZ());
  const Vec3 hip{-side * kAway, kDown, 0};
  Body leg;
  leg.name = side < 0 ? "left leg" : "right leg";
  leg.position = scene.at(cabin).position - spread_rotation * hip;
  leg.rotation = spread_rotation;
  leg.shapes = {shape_of(Polygon::box(2 * kPixel, 8 * kPixel))};
  leg.shapes[0].density = 1;
  leg.shapes[0].material.friction = 0.2;
  leg.shapes[0].filter = {kLander, kGround};
  const BodyId index = scene.add(leg);
  HingeJoint hinge;
  hinge.limit = side < 0 ? Limit{-kFolded, -kSpread, {}} : Limit{kSpread, kFolded, {}};
  hinge.drive = Drive{0, -0.3 * side, {}, 40};
  Joint joint;
  joint.name = leg.name;
  joint.type = hinge;
  joint.body_a = cabin;
  joint.body_b = index;
  joint.frame_b.position = hip;
  scene.add(joint);
  return index;
}

Craft make_craft(const char* name) {
  Craft made;
  Task named;
  named.name = name;
  Scene& scene = made.scene = planar_scene(named, kDt, 10);
  // With fewer, 5 kg on legs of 70 g sway for ever, and never are at rest.
  scene.options.solver.iterations = 3;
  // There is no ceiling there either.
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-20, -10, -1), Vec3(20, 4000, 1));
  add_ground(scene);
  Body cabin;
  cabin.name = "lander";
  cabin.position = {0, kStart, 0};
  Polygon hull;
  for (const auto& [x, y] :
       {std::pair(-17, -10), {17, -10}, {17, 0}, {14, 17}, {-14, 17}, {-17, 0}})
    hull.vertices.emplace_back(x * kPixel, y * kPixel);
  cabin.shapes = {shape_of(hull)};
  cabin.shapes[0].density = 5;
  cabin.shapes[0].material.friction = 0.1;
  cabin.shapes[0].filter = {kLander, kGround};
  // The force of the first step moves the cabin alone; its legs are drawn along.
  const double most = kMaxForce * kDt / mass_properties(scene, cabin).mass;
  cabin.jitter.linear_velocity = {most, most, 0};
  made.cabin = scene.add(cabin);
  made.left = add_leg(scene, made.cabin, -1);
  made.right = add_leg(scene, made.cabin, 1);
  const double low = 4 * kPixel, high = 14 * kPixel, away = 12 * kPixel;  // m, where engines act
  scene.controls = {
      thrust("main", made.cabin, {0, -low, 0}, {0, 1, 0}, 0, kMainThrust),
      thrust("left", made.cabin, {-away, high, 0}, {1, 0, 0}, 0, kSideThrust),
      thrust("right", made.cabin, {away, high, 0}, {-1, 0, 0}, 0, kSideThrust),
  };
  return made;
}

Expression slow(BodyId body) {
  using namespace terms;
  return (square(velocity(body, 0)) + square(velocity(body, 1)) < kSlow * kSlow) &
         (abs(angular_velocity(body, 2)) < kSlowTurn);
}

// `main`: share of the main engine's thrust; `side`: of the left engine's, which drives to the
// right, or, negative, of the right one's.
Task lander(const char* name, const Expression& main, const Expression& side) {
  using namespace terms;
  const auto [scene, cabin, left, right] = make_craft(name);
  Task task;
  task.name = name;
  task.scene = scene;
  task.controls = {kMainThrust * main, kSideThrust * max(side, 0), kSideThrust * max(-side, 0)};

  // There the height is over 18 pixels above a pad that is drawn 1 pixel higher than it lies.
  const double standing = 19 * kPixel;
  const Expression x = position(cabin, 0) / kWidth, y = (position(cabin, 1) - standing) / kHeight,
                   vx = velocity(cabin, 0) / kSpeedX, vy = velocity(cabin, 1) / kSpeedY,
                   lean = angle(cabin), turn = angular_velocity(cabin, 2) / kSpinUnit,
                   on_left = touching(left), on_right = touching(right);
  // Its first leg is the right one.
  task.observations = {{"x", x, -2.5, 2.5},
                       {"y", y, -2.5, 2.5},
                       {"vx", vx, -10, 10},
                       {"vy", vy, -10, 10},
                       {"angle", lean, -6.2831855, 6.2831855},
                       {"turn", turn, -10, 10},
                       {"right leg", on_right, 0, 1},
                       {"left leg", on_left, 0, 1}};

  const Expression landed = (held(slow(cabin) & slow(left) & slow(right)) >= kRest) & !lost();
  const Expression crashed = (touching(cabin) | (abs(x) >= 1) | lost()) & !landed;
  const Expression potential = -100 * sqrt(square(x) + square(y)) -
                               100 * sqrt(square(vx) + square(vy)) - 100 * abs(lean) +
                               10 * on_left + 10 * on_right;
  const auto in_flight = [&](const Expression& e) { return select(crashed | landed, 0, e); };
  task.rewards = {{"potential", in_flight(potential - previous(potential))},
                  {"main engine", in_flight(-0.3 * main)},
                  {"side engines", in_flight(-0.03 * abs(side))},
                  {"landed", select(landed, 100, 0)},
                  {"crashed", select(crashed, -100, 0)}};
  task.terminated = crashed | landed;
  task.max_steps = 1000;
  task.solved_at = 200;
  return task;
}

}  // namespace

Task lunar_lander() {
  const Expression a = terms::action();
  Task task = lander("LunarLander", equal(a, 2), equal(a, 3) - equal(a, 1));
  task.choices = 4;
  return task;
}

Task lunar_lander_continuous() {
  using terms::action;
  // The main engine runs at half its thrust or more, the side engines too.
  const Expression main = select(action(0) > 0, 0.5 + 0.5 * action(0), 0),
                   side = select(abs(action(1)) > 0.5, action(1), 0);
  Task task = lander("LunarLanderContinuous", main, side);
  task.actions = {{"main engine", -1, 1}, {"side engines", -1, 1}};
  return task;
}

}  // namespace manyworlds::tasks
