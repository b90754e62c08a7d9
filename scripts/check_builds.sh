#!/usr/bin/env bash
# Builds the package as users do, with catkin_make and with catkin build --install, and tries what
# was installed: without the sources, and with nothing in the environment but ROS itself.
#   scripts/check_builds.sh [FOLDER]        FOLDER for the workspaces, a temporary one if not given
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
"$here/setup.sh" --test
. "$here/env.sh"

work=${1:-}
if [ -z "$work" ]; then
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
fi
mkdir -p "$work/home" && work=$(cd "$work" && pwd)
# Headers take most of the time, so eight sources at once.
options=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCATKIN_ENABLE_TESTING=OFF -DCMAKE_UNITY_BUILD=ON)

say() { echo "check_builds: $*"; }

quietly() {  # COMMAND...: shows what it prints only if it fails
  if ! "$@" >"$work/log" 2>&1; then
    cat "$work/log" >&2
    say "failed: $*" >&2
    return 1
  fi
}

printed() {  # TEXT COMMAND...: that the command prints this text
  local text=$1
  shift
  quietly "$@"
  grep -qF "$text" "$work/log" && return
  cat "$work/log" >&2
  say "no $text in what this prints: $*" >&2
  return 1
}

copy_sources() {  # WORKSPACE
  mkdir -p "$1/src/scan_image_slam"
  (cd "$repository" && git ls-files -z --cached --others --exclude-standard |
    while IFS= read -r -d '' file; do [ -e "$file" ] && printf '%s\0' "$file"; done |
    tar -c --null -T - -f -) | tar -x -C "$1/src/scan_image_slam"
}

# ---- catkin_make ----
copy_sources "$work/make"
say "catkin_lint"
# Not findings: names with the project's in capitals, the project's name written out, and the
# scripts for developers, which are not installed.
quietly catkin_lint -W2 --strict --offline --ignore literal_project_name \
  --ignore global_var_collision --ignore uninstalled_script \
  "$work/make/src/scan_image_slam"
say "catkin_make"
export CCACHE_BASEDIR=$work/make CCACHE_NOHASHDIR=1
(cd "$work/make" && quietly catkin_make -j "$jobs" "${options[@]}")

# ---- catkin build --install ----
copy_sources "$work/build"
say "catkin build --install"
export CCACHE_BASEDIR=$work/build
(
  cd "$work/build"
  quietly catkin config --init --install --cmake-args "${options[@]}"
  quietly catkin build --no-status -j "$jobs" -p 1
)
rm -rf "$work/build/src" "$work/build/build" "$work/build/devel"

# ---- what is installed ----
install=$work/build/install
programs=$install/lib/scan_image_slam
mkdir -p "$work/home"
clean() {
  env -i HOME="$work/home" PATH=/usr/bin:/bin ROS_MASTER_URI=http://localhost:1 "$@"
}
sourced() {  # COMMAND...: as a user who has sourced the workspace
  # Within a function without arguments, as the set-up file would take ours for its own.
  clean bash -c 'load() { . "$0/setup.bash"; }; load; exec "$@"' "$install" "$@"
}

say "tools without any set-up"
for tool in slam_offline simulate evaluate_trajectory evaluate_relations evaluate_map \
  list_parameters check_bag; do
  quietly clean "$programs/$tool" --help
done
quietly clean "$programs/simulate" --world corridor --out "$work/run.bag" --duration 1
quietly clean "$programs/slam_offline" --bag "$work/run.bag" --out "$work/out" --config paper
quietly clean "$programs/evaluate_trajectory" "$work/run.gt.tum" "$work/out/online.tum" \
  --plot "$work/out/errors.png"
[ -s "$work/out/errors.png" ]
quietly clean "$programs/evaluate_map" corridor "$work/run.gt.tum" "$work/out/map.yaml"

say "rosrun of every program"
found=0
for program in "$programs"/*; do
  name=$(basename "$program")
  found=$((found + 1))
  # A node waits for the master: that it starts and finds its libraries is what is looked at.
  status=0
  sourced timeout 2 rosrun scan_image_slam "$name" --help >"$work/log" 2>&1 || status=$?
  if [ "$status" -ne 0 ] && [ "$status" -ne 124 ]; then
    cat "$work/log" >&2
    say "rosrun scan_image_slam $name ended with $status" >&2
    exit 1
  fi
done
[ "$found" -ge 12 ] || { say "only $found programs are installed" >&2; exit 1; }

say "roslaunch of every launch file"
for file in "$repository"/launch/*.launch; do
  name=$(basename "$file")
  node=/mapper
  case "$name" in
    bag.launch) arguments=("bag:=$work/run.bag") ;;
    record.launch) arguments=(image_transport:=raw) node=/record ;;
    robot_side.launch) arguments=() node=/bounded_icp ;;
    # Drivers are not installed everywhere.
    tetra_ds3.launch) arguments=(start_laser:=false start_camera:=false) ;;
    *) arguments=() ;;
  esac
  printed "$install/share/scan_image_slam/launch/$name" \
    sourced roslaunch --files scan_image_slam "$name" "${arguments[@]}"
  printed "$node" sourced roslaunch --nodes scan_image_slam "$name" "${arguments[@]}"
done

say "plugins: nodelets, the panel of rviz"
for kind in nodelet rviz; do
  plugins=$install/share/scan_image_slam/${kind}_plugins.xml
  printed "scan_image_slam $plugins" sourced rospack plugins --attrib=plugin "$kind"
  library=$install/$(sed -n 's/.*<library path="\(.*\)">.*/\1/p' "$plugins").so
  quietly sourced ldd "$library"
  if grep 'not found' "$work/log" >&2; then exit 1; fi
done

say "another package against the installed headers and libraries"
mkdir -p "$work/user"
cat >"$work/user/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.16)
project(user CXX)
set(CMAKE_CXX_STANDARD 17)
find_package(scan_image_slam REQUIRED)
add_executable(user user.cpp)
target_include_directories(user PRIVATE ${scan_image_slam_INCLUDE_DIRS})
target_link_libraries(user ${scan_image_slam_LIBRARIES})
END
cat >"$work/user/user.cpp" <<'END'
#include <scan_image_slam/ScanMatch.h>
#include <scan_image_slam/core/pipeline/slam_pipeline.h>
int main() {
  scan_image_slam::SlamPipeline pipeline({}, [](const scan_image_slam::PipelineResult&) {});
  pipeline.Finish();
  return pipeline.dropped() + static_cast<int>(scan_image_slam::ScanMatch().candidates);
}
END
quietly sourced cmake -S "$work/user" -B "$work/user/build" -DCMAKE_BUILD_TYPE=Release
quietly sourced cmake --build "$work/user/build"
quietly sourced "$work/user/build/user"
say "all passed"
