#include "src/mjcf/model.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

namespace manyworlds::mjcf {
namespace {

// Calls visit(element, compiled id) for each element of the type that the compiler kept.
template <typename Visit>
void for_each_element(const mjSpec* spec, mjtObj type, int count, Visit visit) {
  for (mjsElement* element = mjs_firstElement(spec, type); element != nullptr;
       element = mjs_nextElement(spec, element)) {
    const int id = mjs_getId(element);
    if (id >= 0 && id < count) visit(element, static_cast<std::size_t>(id));
  }
}

// The wheel's MuJoCo has another std::string than ours: only mjs_getString may read mjString.
// `info` is "line 12", empty, or "line 0" in what was included, whose lines MuJoCo does not keep.
std::string with_line(std::string place, const mjString* info) {
  const char* line = info == nullptr ? nullptr : mjs_getString(info);
  if (line != nullptr && *line != '\0' && std::string_view(line) != "line 0")
    place += std::string(", ") + line;
  return place;
}

std::string quoted(const std::string& kind, const std::string& name, int id) {
  return kind + (name.empty() ? " " + std::to_string(id) : " '" + name + "'");
}

}  // namespace

Model::Model(SpecPtr parsed, ModelPtr model)
    : spec(std::move(parsed)),
      compiled(std::move(model)),
      geoms(static_cast<std::size_t>(compiled->ngeom)),
      bodies(static_cast<std::size_t>(compiled->nbody)),
      joints(static_cast<std::size_t>(compiled->njnt)),
      equalities(static_cast<std::size_t>(compiled->neq)),
      actuators(static_cast<std::size_t>(compiled->nactuator)),
      articulated(std::any_of(compiled->jnt_type, compiled->jnt_type + compiled->njnt,
                              [](int type) { return type != mjJNT_FREE; })) {
  const auto size = [](const auto& list) { return static_cast<int>(list.size()); };
  for_each_element(spec.get(), mjOBJ_GEOM, size(geoms),
                   [&](mjsElement* e, std::size_t id) { geoms[id] = mjs_asGeom(e); });
  for_each_element(spec.get(), mjOBJ_BODY, size(bodies),
                   [&](mjsElement* e, std::size_t id) { bodies[id] = mjs_asBody(e); });
  for_each_element(spec.get(), mjOBJ_JOINT, size(joints),
                   [&](mjsElement* e, std::size_t id) { joints[id] = mjs_asJoint(e); });
  for_each_element(spec.get(), mjOBJ_EQUALITY, size(equalities),
                   [&](mjsElement* e, std::size_t id) { equalities[id] = mjs_asEquality(e); });
  for_each_element(spec.get(), mjOBJ_ACTUATOR, size(actuators),
                   [&](mjsElement* e, std::size_t id) { actuators[id] = mjs_asActuator(e); });
}

std::string Model::name(mjtObj type, int id) const {
  const char* text = mj_id2name(compiled.get(), type, id);
  return text == nullptr ? "" : text;
}

std::string Model::body_place(int body) const {
  const mjsBody* written = bodies[static_cast<std::size_t>(body)];
  return with_line(quoted("body", name(mjOBJ_BODY, body), body),
                   written == nullptr ? nullptr : written->info);
}

std::string Model::geom_place(int geom) const {
  const mjsGeom* written = geoms[static_cast<std::size_t>(geom)];
  const int body = compiled->geom_bodyid[geom];
  return with_line(quoted("geom", name(mjOBJ_GEOM, geom), geom) + " of " +
                       quoted("body", name(mjOBJ_BODY, body), body),
                   written == nullptr ? nullptr : written->info);
}

std::string Model::joint_place(int joint) const {
  const mjsJoint* written = joints[static_cast<std::size_t>(joint)];
  const int body = compiled->jnt_bodyid[joint];
  return with_line(quoted("joint", name(mjOBJ_JOINT, joint), joint) + " of " +
                       quoted("body", name(mjOBJ_BODY, body), body),
                   written == nullptr ? nullptr : written->info);
}

std::string Model::equality_place(int equality) const {
  const mjsEquality* written = equalities[static_cast<std::size_t>(equality)];
  return with_line(quoted("equality", name(mjOBJ_EQUALITY, equality), equality),
                   written == nullptr ? nullptr : written->info);
}

std::string Model::actuator_place(int actuator) const {
  const mjsActuator* written = actuators[static_cast<std::size_t>(actuator)];
  return with_line(quoted("actuator", name(mjOBJ_ACTUATOR, actuator), actuator),
                   written == nullptr ? nullptr : written->info);
}

std::string Model::place(mjtObj type, int id) const {
  return quoted(mju_type2Str(type), name(type, id), id);
}

bool Model::contacts_enabled() const {
  return (compiled->opt.disableflags & (mjDSBL_CONTACT | mjDSBL_CONSTRAINT)) == 0;
}

bool Model::collides(int geom) const {
  return contacts_enabled() &&
         (compiled->geom_contype[geom] != 0 || compiled->geom_conaffinity[geom] != 0);
}

int Model::carrier(int body) const {
  const mjModel& m = *compiled;
  if (m.body_weldid[body] == 0) return body;
  if (!articulated) return m.body_weldid[body];
  while (m.body_mass[body] == 0 && m.body_jntnum[body] == 0) body = m.body_parentid[body];
  return body;
}

bool any_nonzero(const mjtNum* values, int count) {
  return std::any_of(values, values + count, [](mjtNum v) { return v != 0; });
}

const char* geom_type_name(int type) {
  switch (type) {
    case mjGEOM_PLANE: return "plane";
    case mjGEOM_HFIELD: return "hfield";
    case mjGEOM_SPHERE: return "sphere";
    case mjGEOM_CAPSULE: return "capsule";
    case mjGEOM_ELLIPSOID: return "ellipsoid";
    case mjGEOM_CYLINDER: return "cylinder";
    case mjGEOM_BOX: return "box";
    case mjGEOM_MESH: return "mesh";
    case mjGEOM_SDF: return "sdf";
    default: return "geom of unknown type";
  }
}

const char* joint_type_name(int type) {
  switch (type) {
    case mjJNT_FREE: return "free joint";
    case mjJNT_BALL: return "ball joint";
    case mjJNT_SLIDE: return "slide joint";
    case mjJNT_HINGE: return "hinge";
    default: return "joint of unknown type";
  }
}

}  // namespace manyworlds::mjcf
