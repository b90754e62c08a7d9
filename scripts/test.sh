#!/usr/bin/env bash
# All tests and checks, on a fresh Debian 12 or Ubuntu 20.04 machine: installs, builds, tests.
#   scripts/test.sh              everything
#   scripts/test.sh unit tidy    only these steps (and the build they need)
# Steps: format build unit tools live sanitize threads fuzz bench tidy builds
# Prints one line for each step, and all that a step has said if it fails. Tests with recorded data
# look for it in ../shared/data, or in the folder SCAN_IMAGE_SLAM_DATA.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
all_steps=(format build unit tools live sanitize threads fuzz bench tidy builds)
steps=("$@")
[ $# -eq 0 ] && steps=("${all_steps[@]}")
for step in "${steps[@]}"; do
  if [[ " ${all_steps[*]} " != *" $step "* ]]; then
    echo "test.sh: there is no step $step; there are: ${all_steps[*]}" >&2
    exit 1
  fi
done

"$here/setup.sh" --test
. "$here/env.sh"
export SETUP_OPTIONS=--test
export SCAN_IMAGE_SLAM_DATA=${SCAN_IMAGE_SLAM_DATA:-$repository/../shared/data}
build=$repository/build_test
sanitized=$repository/build_sanitize
threaded=$repository/build_threads
logs=$build/logs
mkdir -p "$logs"
passed=0
failed=0

sources() { (cd "$repository" && git ls-files -- "$@"); }

run_format() {
  (cd "$repository" && sources '*.h' '*.cpp' | xargs clang-format --dry-run --Werror)
}

run_build() {
  BUILD_TARGETS="all tests" "$here/build.sh" "$build" -DSCAN_IMAGE_SLAM_WERROR=ON \
    -DSCAN_IMAGE_SLAM_BENCH=ON
}

# Sourced set-up files name the folder; programs and launch files are found by it.
in_devel_space() {  # FOLDER COMMAND...
  local folder=$1
  shift
  # Within a function without arguments, as the set-up file would take ours for its own.
  load() { set +u && . "$folder/devel/setup.bash" && set -u; }
  (load && "$@")
}

run_ctest() {  # FOLDER OPTIONS...: fails as well if no test was found
  local folder=$1
  shift
  (cd "$folder" && in_devel_space "$folder" ctest --output-on-failure "$@") | tee "$logs/ctest"
  ! grep -q 'No tests were found' "$logs/ctest"
}

run_unit() { run_ctest "$build" -j "$jobs" -R '_gtest_'; }
run_tools() { run_ctest "$build" -j "$jobs" -R '^tools_'; }

# Live nodes have the machine to themselves.
run_live() {
  if ! (cd "$build" && ctest -N -E '_gtest_|^tools_') | grep -q 'Total Tests: 0'; then
    run_ctest "$build" -E '_gtest_|^tools_'
  fi
}

# Headers take most of the time, so eight sources at once. Without ccache, which would read the
# precompiled headers again for every source.
clang_options=(-DCMAKE_CXX_COMPILER=clang++ -DCMAKE_CXX_COMPILER_LAUNCHER=
  -DSCAN_IMAGE_SLAM_PRECOMPILE=ON -DCMAKE_UNITY_BUILD=ON -DCMAKE_BUILD_TYPE=RelWithDebInfo
  -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -gline-tables-only")

asan_options=verify_asan_link_order=0  # it stands behind our libraries, which allocate nothing themselves

# With what the fuzzer needs, so that the fuzz programs take the same libraries.
build_sanitized() {  # TARGETS...
  BUILD_TARGETS=$* "$here/build.sh" "$sanitized" -DSCAN_IMAGE_SLAM_FUZZ=ON "${clang_options[@]}"
}

live_programs=(scan_image_fusion bounded_icp mapper slam_offline simulate)

run_sanitize() {
  build_sanitized "${live_programs[@]}" scan_image_slam_nodelets ros_messages_test \
    $(cd "$repository/test/core" && printf 'core_%s_test ' *)
  # Libraries of ROS leak what lives as long as the program.
  export ASAN_OPTIONS=$asan_options:detect_leaks=0:detect_stack_use_after_return=1
  run_ctest "$sanitized" -j "$jobs" -R '_gtest_(core_|ros_messages)'
  # The live graph, bags at half their speed. The manager of nodelets is a program of ROS, so the
  # sanitizer is loaded before.
  export SCAN_IMAGE_SLAM_PLAY_RATE=0.5
  LD_PRELOAD=$(clang++ -print-file-name=libclang_rt.asan-x86_64.so) \
    run_ctest "$sanitized" -R 'test_nodes_(whole_graph|whole_graph_nodelets|mapper_state)\.test'
}

# The live graph with the thread sanitizer; test/tsan_suppressions.txt tells what it can't know.
run_threads() {
  BUILD_TARGETS="${live_programs[*]} core_mapping_test" "$here/build.sh" "$threaded" \
    -DSCAN_IMAGE_SLAM_SANITIZE=thread "${clang_options[@]}"
  export SCAN_IMAGE_SLAM_PLAY_RATE=0.25
  # Threads of roscpp and log4cxx take their own mutexes in either order.
  export TSAN_OPTIONS=detect_deadlocks=0:suppressions=$repository/test/tsan_suppressions.txt
  "$threaded/devel/lib/scan_image_slam/core_mapping_test" --gtest_filter='BackEndThread.*'
  run_ctest "$threaded" -R 'test_nodes_(whole_graph|mapper_state)\.test'
}

# A few seconds each; what they find is kept in $found, and belongs into test/fuzz/corpus.
run_fuzz() {
  build_sanitized fuzz_programs
  export ASAN_OPTIONS=$asan_options
  local found=$sanitized/found source name seeds
  for source in "$repository"/test/fuzz/*_fuzz.cpp; do
    name=$(basename "$source" .cpp)
    seeds=("$repository/test/fuzz/corpus/$name")
    [ "$name" = yaml_fuzz ] && seeds+=("$repository/config" "$repository/config/worlds")
    mkdir -p "$found/$name"
    echo "$name"
    "$sanitized/devel/lib/scan_image_slam/$name" -seed=1 -max_total_time=6 -timeout=20 \
      -artifact_prefix="$found/$name-" "$found/$name" "${seeds[@]}" 2>&1
  done
}

# That they run, not how fast: machines differ.
run_bench() { "$build/devel/lib/scan_image_slam/stages_bench" --benchmark_min_time=0.01; }

run_tidy() { "$here/tidy.py" "$build" --jobs "$jobs"; }

run_builds() { "$here/check_builds.sh"; }

run_step() {  # NAME
  local begin=$SECONDS log=$logs/$1.log status=0
  # Not as a condition: that would switch -e off within.
  set +e
  (set -e; "run_$1") >"$log" 2>&1 </dev/null
  status=$?
  set -e
  if [ "$status" -eq 0 ]; then
    passed=$((passed + 1))
    printf '%-9s passed  %4d s\n' "$1" $((SECONDS - begin))
    grep -hiE '(^|[^a-z])skipped' "$log" | sort -u | sed 's/^/          /' || true
  else
    failed=$((failed + 1))
    cat "$log"
    printf '%-9s FAILED  %4d s\n' "$1" $((SECONDS - begin))
  fi
}

if [[ " ${steps[*]} " != *" build "* && " ${steps[*]} " =~ \ (unit|tools|live|bench|tidy)\  ]]; then
  steps=(build "${steps[@]}")
fi
[ -d "$SCAN_IMAGE_SLAM_DATA" ] ||
  echo "there are no recordings in $SCAN_IMAGE_SLAM_DATA: tests that need them are skipped"
for step in "${steps[@]}"; do
  run_step "$step"
  [ "$step" = build ] && [ "$failed" -gt 0 ] && break
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
