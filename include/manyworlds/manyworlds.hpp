// The whole public API of the core library in one include.
#pragma once

#include "manyworlds/require_cxx20.hpp"  // first

#include "manyworlds/batch.hpp"
#include "manyworlds/environment.hpp"
#include "manyworlds/executor.hpp"
#include "manyworlds/expression_graph.hpp"
#include "manyworlds/fields.hpp"
#include "manyworlds/gymnasium.hpp"
#include "manyworlds/hull.hpp"
#include "manyworlds/ids.hpp"
#include "manyworlds/listener.hpp"
#include "manyworlds/mesh.hpp"
#include "manyworlds/plan.hpp"
#include "manyworlds/scene.hpp"
#include "manyworlds/scenes.hpp"
#include "manyworlds/surface.hpp"
#include "manyworlds/task.hpp"
#include "manyworlds/tasks.hpp"
