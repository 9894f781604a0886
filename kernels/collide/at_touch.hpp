// Contacts with fixed shapes, with the normal of the moment of touch.
//
// Rows keep one normal for a step. The normal of the step's start stops what slides or rolls over
// the seam between two fixed shapes: there the nearest feature of the next shape is its side. So
// the body's shape is moved along its velocity to where it touches, and what is found there becomes
// the contact.
//
// The separation of two convex shapes is a convex function of a translation, s(x) >= s + n . x for
// what is found at any place, so each place bounds the separation on the whole way from below:
//   - no bound below -overlap within the step: the shapes do not touch, nothing is searched;
//   - Newton steps towards s = -overlap never pass the first place where it holds, so that place is
//     the touch;
//   - a Newton step after which the separation rises proves that the shapes pass each other. The
//     plane between them that is parallel to the way is a positive sum of both places' planes.
// `overlap` is what bodies at rest overlap by at most, so that a floor is not a step in front of
// them. Where the normal of touch is that of the start, nothing changes.
#pragma once

#include "kernels/collide/manifold.hpp"
#include "kernels/shape/tangent.hpp"
#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr int kTouchRounds = 10;
inline constexpr Real kLittle = Real(0.125);  // of the overlap
inline constexpr Real kFarApart = Real(1e30);

// Not inlined, like the searches, since it runs for few contacts.
template <class S, int N>
__attribute__((noinline)) void take_manifold(Mask use, const Manifold<S, N>& from,
                                             Manifold<S, N>& m) {
  m.normal = select(use, from.normal, m.normal);
  if constexpr (S::kDim == 3) m.tangent = select(use, from.tangent, m.tangent);
  for (int i = 0; i < N; ++i) {
    m.point_a[i] = select(use, from.point_a[i], m.point_a[i]);
    m.point_b[i] = select(use, from.point_b[i], m.point_b[i]);
    m.separation[i] = select(use, from.separation[i], m.separation[i]);
    m.feature_x[i] = select(use, from.feature_x[i], m.feature_x[i]);
    m.feature_y[i] = select(use, from.feature_y[i], m.feature_y[i]);
    m.valid[i] = (use & from.valid[i]) | (m.valid[i] & !use);
    m.guard[i] = (use & from.guard[i]) | (m.guard[i] & !use);
  }
  m.code = select(use, from.code, m.code);
  m.match_distance2 = select(use, from.match_distance2, m.match_distance2);
}

// What is found with B moved on by the way of a time.
template <class S, int N>
struct Place {
  Manifold<S, N> m;
  Float time, separation, speed;  // of the nearest point; along the normal

  MW_INLINE void take(Mask use, const Place& from) {
    take_manifold(use, from.m, m);
    time = select(use, from.time, time);
    separation = select(use, from.separation, separation);
    speed = select(use, from.speed, speed);
  }
  // As seen from where B is at the step's start.
  MW_INLINE void move_back(typename S::Vec velocity) {
    const Float along = speed * time;
    const auto shift = fnma(m.normal, along, velocity * time);
    for (int i = 0; i < N; ++i) {
      m.separation[i] = m.separation[i] - along;
      m.point_a[i] = m.point_a[i] - shift;
    }
  }
};

template <class S, int N>
class TouchSearch {
 public:
  using Vec = typename S::Vec;

  // `ball`: B is one, whose point is always along the normal.
  MW_INLINE void start(const Constants& t, const Velocity<S>& velocity, Mask active, bool ball) {
    velocity_ = velocity;
    dt_ = t.dt, overlap_ = t.face_bias, time_ = Real(0);
    going_ = active, ball_ = ball, round_ = 0;
  }

  // After each m that was found with B moved on by way(), in the lanes of going(). false: that was
  // the last, and m is the contact. Otherwise m is empty for the next.
  bool go_on(Manifold<S, N>& m);

  MW_INLINE Vec way() const { return velocity_.v * time_; }
  MW_INLINE Mask going() const { return going_; }

 private:
  MW_INLINE bool begin(const Place<S, N>& here);
  MW_INLINE Mask turns_little(const Manifold<S, N>& m, Float speed) const;
  MW_INLINE void take_touch(Mask use, const Place<S, N>& here);
  MW_INLINE void take_passing(Mask use, const Place<S, N>& here);

  Velocity<S> velocity_;  // of B's origin
  Float dt_, overlap_, time_;
  Mask going_;
  bool ball_;
  int round_;
  Manifold<S, N> out_;
  Vec start_normal_;
  Place<S, N> last_;  // the latest with a separation that falls
};

// Lanes in which the points approach as B's origin does: the search moves shapes and does not
// rotate them.
template <class S, int N>
MW_INLINE Mask TouchSearch<S, N>::turns_little(const Manifold<S, N>& m, Float speed) const {
  const Float most = abs(speed) * Real(0.5);
  Mask out = mask_from_bits(kAllLanes);
  for (int i = 0; i < N; ++i) {
    const Float by_spin = dot(m.normal, cross(velocity_.w, m.point_b[i]));
    const Mask none = !m.valid[i];
    out = out & (none | (abs(by_spin) <= most));
  }
  return out;
}

template <class S, int N>
MW_INLINE bool TouchSearch<S, N>::begin(const Place<S, N>& here) {
  const Float little = overlap_ * Real(kLittle), way = here.speed * dt_;
  going_ =
      going_ & (way < -little) & (-overlap_ < here.separation) & (here.separation + way < little);
  if (!any(going_)) return false;
  going_ = going_ & turns_little(here.m, here.speed);
  if (!any(going_)) return false;
  out_ = here.m;
  start_normal_ = here.m.normal;
  last_ = here;
  return true;
}

template <class S, int N>
MW_INLINE void TouchSearch<S, N>::take_touch(Mask use, const Place<S, N>& here) {
  const Mask turned = use & (dot(here.m.normal, start_normal_) < Float(Real(1 - 1e-5)));
  if (!any(turned)) return;
  Place<S, N> back = here;
  back.move_back(velocity_.v);
  take_manifold(turned, back.m, out_);
}

template <class S, int N>
MW_INLINE void TouchSearch<S, N>::take_passing(Mask use, const Place<S, N>& here) {
  const Float one(Real(1));
  const Mask later = abs(here.speed) < abs(last_.speed);
  Place<S, N> back = last_;
  back.take(later, here);
  const Vec sum = last_.m.normal * here.speed - here.m.normal * last_.speed;
  const Float length2 = dot(sum, sum);
  const Mask real = use & (Float(Real(0)) < length2);
  const Vec n = sum * (one / sqrt(select(real, length2, one)));
  const Float gain = min(last_.separation, here.separation) - back.separation;
  for (int i = 0; i < N; ++i) {
    back.m.separation[i] = back.m.separation[i] + gain;
    if (ball_) back.m.point_b[i] = n * dot(back.m.normal, back.m.point_b[i]);
  }
  back.m.normal = n;
  if constexpr (S::kDim == 3) back.m.tangent = any_tangent(n);
  back.speed = Real(0);
  back.move_back(velocity_.v);
  take_manifold(real, back.m, out_);
}

template <class S, int N>
__attribute__((noinline)) bool TouchSearch<S, N>::go_on(Manifold<S, N>& m) {
  // Search two steps: shapes that touch in this step overlap in the next.
  const Float zero(Real(0)), far(kFarApart), longest = dt_ + dt_;
  Place<S, N> here;
  here.m = m;
  here.time = time_;
  here.speed = dot(m.normal, velocity_.v);
  here.separation = far;
  for (int i = 0; i < N; ++i) {
    here.separation = min(here.separation, select(m.valid[i] & !m.guard[i], m.separation[i], far));
  }
  if (round_++ == 0) {
    if (!begin(here)) return false;
  } else {
    // No points near each other: apart along a direction, by how much is not known.
    const Mask found = here.separation < far;
    here.separation = select(found, here.separation, zero);
    // Where the way was not convex, the contact of the start stays.
    going_ = going_ & (-(overlap_ + overlap_) < here.separation);
    const Mask falls = here.speed < zero;
    const Mask level = (abs(here.speed) * dt_ < overlap_ * Real(kLittle)) | (!found & !falls);
    const Mask there = here.separation < overlap_ * Real(kLittle - 1);
    const Mask done = level | (falls & (there | (longest <= time_)));
    take_touch(going_ & done, here);
    if (any(going_ & !done & !falls)) take_passing(going_ & !done & !falls, here);
    going_ = going_ & !done & falls;
    if (round_ == kTouchRounds) {
      take_touch(going_, here);
      going_ = zero < zero;
    }
    last_.take(going_, here);
  }
  const Float step = (here.separation + overlap_) / select(going_, -here.speed, Real(1));
  time_ = select(going_, min(time_ + step, longest), time_);
  if (any(going_)) {
    m = {};
    return true;
  }
  m = out_;
  return false;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
