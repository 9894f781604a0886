# Pythons that wheels can be made for and tested with. Sourced by tools/wheel, not run.

# is_usable_python PYTHON: at least 3.10, with its headers and venv.
is_usable_python() {
  "$1" - 2>/dev/null <<'END'
import ensurepip, os, sys, sysconfig, venv
header = os.path.join(sysconfig.get_path("include"), "Python.h")
wanted = sys.implementation.name == "cpython" and not sysconfig.get_config_var("Py_GIL_DISABLED")
sys.exit(not (wanted and sys.version_info >= (3, 10) and os.path.exists(header)))
END
}

# wheel_tag PYTHON: "cp310", "cp311", or "cp312-abi3" from 3.12 on, where one wheel serves all.
wheel_tag() {
  "$1" -c 'import sys; m = sys.version_info[1]; print("cp312-abi3" if m >= 12 else f"cp3{m}")'
}

# find_pythons: one of each version from 3.10 to 3.14: Debian's first, then what is in PATH and in pyenv.
find_pythons() {
  local minor candidate
  for minor in 10 11 12 13 14; do
    for candidate in "/usr/bin/python3.$minor" "/usr/local/bin/python3.$minor" "$(type -P "python3.$minor")" \
      "${PYENV_ROOT:-$HOME/.pyenv}/versions/3.$minor."*/bin/python3; do
      [[ -x $candidate ]] && is_usable_python "$candidate" || continue
      printf '%s\n' "$candidate"
      break
    done
  done
}
