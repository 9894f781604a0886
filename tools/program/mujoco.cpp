// MuJoCo's functions for the program of a wheel. The library is in another package, mujoco-core,
// which not everyone installs: it is opened at the first call. A missing function here is an error
// of the linker, a wrong signature one of the compiler.
#include <dlfcn.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

#include <mujoco/mjbatch.h>
#include <mujoco/mujoco.h>

namespace {

// The library that the Python package found (manyworlds/__main__.py).
constexpr const char* kVariable = "MANYWORLDS_MUJOCO";

void* open_library() {
  const char* file = std::getenv(kVariable);
  if (file == nullptr || *file == 0) {
    const char* why = std::getenv("MANYWORLDS_NO_MUJOCO");
    if (why != nullptr && *why != 0) throw std::runtime_error(why);
    throw std::runtime_error(
        "MJCF files need MuJoCo's library, which is not installed; install it with: "
        "pip install 'manyworlds-sim[mjcf]'");
  }
  if (void* library = dlopen(file, RTLD_NOW | RTLD_LOCAL)) return library;
  const char* reason = dlerror();
  throw std::runtime_error(std::string("MuJoCo's library cannot be opened: ") +
                           (reason != nullptr ? reason : file));
}

// Throws std::runtime_error, at every call until it succeeds.
void* find(const char* name) {
  static void* const library = open_library();
  if (void* found = dlsym(library, name)) return found;
  throw std::runtime_error(std::string("MuJoCo's library has no function ") + name);
}

}  // namespace

#define MW_FORWARD(Result, name, parameters, ...)                             \
  Result name parameters {                                                    \
    static const auto found = reinterpret_cast<decltype(&name)>(find(#name)); \
    return found(__VA_ARGS__);                                                \
  }

extern "C" {
MW_FORWARD(int, mj_addBufferVFS, (mjVFS * vfs, const char* name, const void* buffer, int nbuffer),
           vfs, name, buffer, nbuffer)
MW_FORWARD(mjModel*, mj_compile, (mjSpec * s, const mjVFS* vfs), s, vfs)
MW_FORWARD(void, mj_defaultOption, (mjOption * opt), opt)
MW_FORWARD(void, mj_defaultVFS, (mjVFS * vfs), vfs)
MW_FORWARD(void, mj_deleteData, (mjData * d), d)
MW_FORWARD(void, mj_deleteModel, (mjModel * m), m)
MW_FORWARD(void, mj_deleteSpec, (mjSpec * s), s)
MW_FORWARD(void, mj_deleteVFS, (mjVFS * vfs), vfs)
MW_FORWARD(void, mj_energyVel, (const mjModel* m, mjData* d), m, d)
MW_FORWARD(void, mj_forward, (const mjModel* m, mjData* d), m, d)
MW_FORWARD(const char*, mj_id2name, (const mjModel* m, int type, int id), m, type, id)
MW_FORWARD(void, mj_integratePos, (const mjModel* m, mjtNum* qpos, const mjtNum* qvel, mjtNum dt),
           m, qpos, qvel, dt)
MW_FORWARD(mjData*, mj_makeData, (const mjModel* m), m)
MW_FORWARD(void, mj_normalizeQuat, (const mjModel* m, mjtNum* qpos), m, qpos)
MW_FORWARD(void, mj_objectVelocity,
           (const mjModel* m, const mjData* d, int objtype, int objid, mjtNum res[6],
            int flg_local),
           m, d, objtype, objid, res, flg_local)
MW_FORWARD(mjSpec*, mj_parseXMLString,
           (const char* xml, const mjVFS* vfs, char* error, int error_sz), xml, vfs, error,
           error_sz)
MW_FORWARD(void, mj_resetData, (const mjModel* m, mjData* d), m, d)
MW_FORWARD(void, mj_step, (const mjModel* m, mjData* d), m, d)
MW_FORWARD(int, mj_version, ())
MW_FORWARD(const char*, mj_versionString, ())
MW_FORWARD(void, mjb_defaultConfig, (mjBatchConfig * config), config)
MW_FORWARD(void, mjb_deleteBatch, (mjBatch * b), b)
MW_FORWARD(mjBatch*, mjb_makeBatch,
           (const mjModel* m, int nsim, const mjBatchConfig* config, char* error, int error_sz), m,
           nsim, config, error, error_sz)
MW_FORWARD(int, mjb_nstate, (const mjBatch* b), b)
MW_FORWARD(int, mjb_reset, (mjBatch * b, const int* ids, int nid, const int* key, int stage), b,
           ids, nid, key, stage)
MW_FORWARD(mjtNum*, mjb_stateComponent, (mjBatch * b, int component, int* size), b, component, size)
MW_FORWARD(int, mjb_step, (mjBatch * b, const int* ids, int nid, int nstep, int stage), b, ids, nid,
           nstep, stage)
MW_FORWARD(mjsActuator*, mjs_asActuator, (mjsElement * element), element)
MW_FORWARD(mjsBody*, mjs_asBody, (mjsElement * element), element)
MW_FORWARD(mjsEquality*, mjs_asEquality, (mjsElement * element), element)
MW_FORWARD(mjsGeom*, mjs_asGeom, (mjsElement * element), element)
MW_FORWARD(mjsJoint*, mjs_asJoint, (mjsElement * element), element)
MW_FORWARD(void, mjs_defaultEquality, (mjsEquality * equality), equality)
MW_FORWARD(void, mjs_defaultGeom, (mjsGeom * geom), geom)
MW_FORWARD(mjsElement*, mjs_firstElement, (const mjSpec* s, mjtObj type), s, type)
MW_FORWARD(const char*, mjs_getError, (mjSpec * s), s)
MW_FORWARD(int, mjs_getId, (const mjsElement* element), element)
MW_FORWARD(const char*, mjs_getString, (const mjString* source), source)
MW_FORWARD(mjsElement*, mjs_nextElement, (const mjSpec* s, const mjsElement* element), s, element)
MW_FORWARD(mjfLogHandler, mju_setLogHandler, (mjfLogHandler handler), handler)
MW_FORWARD(const char*, mju_type2Str, (int type), type)
}  // extern "C"
