#!/usr/bin/env bash
# Installs what is missing and builds the package with plain CMake.
#   scripts/build.sh [FOLDER [CMake options]]      FOLDER is build/ if not given
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
"$here/setup.sh" ${SETUP_OPTIONS:-}
. "$here/env.sh"

build=${1:-$repository/build}
[ $# -gt 0 ] && shift
# While it is configured, catkin notes the environment that tests will have, and leaves out folders
# that do not exist yet: the tests of a new folder would not find the Python messages.
mkdir -p "$build/devel/lib/python3/dist-packages"
log=$build/build.log
# Objects are the same in every folder, so that a second build of the same sources is quick.
export CCACHE_BASEDIR=$repository CCACHE_NOHASHDIR=1
echo "building in $build"
if ! cmake -S "$repository" -B "$build" -G Ninja -DCMAKE_CXX_COMPILER_LAUNCHER=ccache "$@" \
    >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi
if ! cmake --build "$build" -j "$jobs" --target ${BUILD_TARGETS:-all} >"$log" 2>&1; then
  grep -vE '^\[[0-9]+/[0-9]+\] ' "$log" >&2
  exit 1
fi
