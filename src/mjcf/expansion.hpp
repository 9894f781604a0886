// How much a model becomes when MuJoCo makes its copies: replicate, attach, flexcomp;
// and what attributes ask for by a number alone.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include <tinyxml2.h>

#include "src/mjcf/files.hpp"

namespace manyworlds::mjcf {

// Of an element and all below it, counted as doubles: products of counts leave every integer.
struct Weight {
  double elements = 0;
  double depth = 0;  // elements inside one another
  double bytes = 0;  // of attributes
  double bodies = 0;
  double keys = 0;          // keyframes
  double sensed = 0;        // numbers that sensors and actuators keep
  double rangefinders = 0;  // each may look through a camera
  double tactiles = 0;      // each may feel every vertex of a mesh

  // As many of the other beside what is here.
  void add(const Weight& other, double times);
};

// What stands at an <include>, and where.
struct Included {
  const tinyxml2::XMLElement* root;
  std::string label;
};
struct Expansion {
  std::map<const tinyxml2::XMLElement*, Included> includes;
  std::map<std::string, Weight> models;  // that <attach> may name
  double pixels = 1;                     // of the largest camera
  double vertices = 1;                   // of the largest mesh, as far as the limits let it be
};

// Throws MjcfError at the first element that goes beyond a limit. `written`: the elements of all
// documents so far, of which none is a copy.
Weight weigh(const tinyxml2::XMLElement& root, const std::string& label, const Expansion& expansion,
             std::int64_t written, FileReader& reader);

}  // namespace manyworlds::mjcf
