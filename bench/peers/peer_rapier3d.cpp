// The spatial scenes in Rapier.
#include "bench/peers/rapier.hpp"

int main(int argc, char** argv) {
  using namespace manyworlds::peers;
  return run_peer(argc, argv, rapier_engine(false));
}
