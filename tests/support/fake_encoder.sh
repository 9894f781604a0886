#!/bin/sh
# Stands for ffmpeg, for tests of films: keeps what it is sent. MODE is what goes wrong.
printf '%s\n' "$@" >arguments
for last; do :; done
if [ "$MODE" = fails ]; then cat >/dev/null; echo "No space left on device" >&2; exit 1; fi
if [ "$MODE" = "ends" ]; then echo "Unknown encoder" >&2; exit 8; fi
cat >"${last#file:}"
