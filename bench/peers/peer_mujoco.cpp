// MuJoCo's plain loop: mj_step of one world after the other.
#include "bench/peers/mujoco.hpp"

int main(int argc, char** argv) {
  using namespace manyworlds::peers;
  return run_peer(argc, argv, mujoco_engine("MuJoCo"));
}
