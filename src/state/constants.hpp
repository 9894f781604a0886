// What the kernels know of one world's bodies and shapes, derived from a plan: all worlds' alike
// where nothing varies, else from a plan of that world's own scene.
#pragma once

#include <cstddef>

#include "kernels/data/tables.hpp"
#include "src/base/aligned_buffer.hpp"
#include "src/plan/plan_data.hpp"

namespace manyworlds {

template <class Real>
kernels::BodyConstants<Real> body_constants(const PlanData& plan, const PlanBody& body);
template <class Real>
kernels::ShapeConstants<Real> shape_constants(const PlanData& plan, const PlanCollider& shape);
template <class Real>
kernels::PolygonConstants<Real> polygon_constants(const PlanCollider& shape);

// One group's constants, or all groups': [item][member][lane] for each kind of item.
template <class Real>
class Constants {
 public:
  // Which kinds of item there are in it; the others' pointers stay null.
  struct Parts {
    bool bodies = true, shapes = true, materials = true, joints = true;
    bool links = true, dofs = true, actuators = true;  // of trees
    bool limits = true, contacts = true;               // of trees, too
    bool attractors = true, thrusts = true;
  };

  Constants() = default;
  Constants(const PlanData& plan, Parts parts, int groups, int lanes);

  const Parts& parts() const { return parts_; }
  kernels::ConstantBlocks<Real> group(int index) const;
  // Writes what `plan` says into a lane.
  void fill(const PlanData& plan, int lane_index);
  void swap(int first, int second);
  void copy(int from, int to);
  std::size_t bytes() const;

 private:
  struct Block {
    AlignedBuffer<Real> numbers;  // [group][rows][lane]
    std::size_t rows = 0;
    const Real* group(std::size_t index, std::size_t lanes) const {
      return numbers.empty() ? nullptr : numbers.data() + index * rows * lanes;
    }
  };
  template <class Self, class Visit>
  static void for_each_block(Self& self, Visit visit) {
    for (auto* block : {&self.bodies_, &self.shapes_, &self.polygons_, &self.materials_,
                        &self.joints_, &self.thrusts_, &self.links_, &self.drags_, &self.dofs_,
                        &self.actuators_, &self.limits_, &self.contacts_, &self.attractors_}) {
      visit(*block);
    }
  }
  // Writes one item of a lane.
  template <class Item>
  void put(Block& block, std::size_t item, const Item& value, int lane_index);

  Parts parts_;
  int lanes_ = 1;
  Block bodies_, shapes_, polygons_, materials_, joints_, thrusts_;
  Block links_, drags_, dofs_, actuators_;
  Block limits_, contacts_, attractors_;
};

}  // namespace manyworlds
