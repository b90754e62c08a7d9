#!/usr/bin/env bash
# The whole system, live, on any Debian 12 or Ubuntu 20.04 machine: installs and builds, lets a
# simulated robot drive through a laboratory, and shows what came out. With a display, in rviz.
#   scripts/demo.sh [FOLDER]        FOLDER for the results, demo/ if not given
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
"$here/build.sh"
. "$here/env.sh"

out=$(mkdir -p "${1:-$repository/demo}" && cd "${1:-$repository/demo}" && pwd)
# Within a function without arguments, as the set-up file would take ours for its own.
load() { set +u && . "$repository/build/devel/setup.bash" && set -u; }
load
rviz=false
[ -n "${DISPLAY:-}" ] && rviz=true
# A master of its own, beside any that may be running.
port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("", 0)); print(s.getsockname()[1])')
export ROS_MASTER_URI=http://localhost:$port ROS_HOME=$out/ros ROS_HOSTNAME=localhost

echo "driving through the simulated laboratory (about 90 seconds)"
roslaunch -p "$port" scan_image_slam simulation.launch \
  rviz:=$rviz record:="$out" map_folder:="$out" >"$out/roslaunch.log" 2>&1 &
launch=$!
stop() { kill -TERM "$launch" 2>/dev/null || true; wait "$launch" 2>/dev/null || true; }
trap stop EXIT
for _ in $(seq 60); do
  rostopic list >/dev/null 2>&1 && break
  sleep 0.5
done

if ! timeout 180 rostopic echo -n 1 /simulation_finished >/dev/null; then
  echo "the drive did not end; see $out/roslaunch.log" >&2
  tail -20 "$out/roslaunch.log" >&2
  exit 1
fi
rosservice call /save_map "name: 'map'" >/dev/null
stop
trap - EXIT

tools=$repository/build/devel/lib/scan_image_slam
key() { tr ' ' '\n' | sed -n "s/^$1=//p"; }
estimate=$("$tools/evaluate_trajectory" "$out/truth.tum" "$out/online.tum")
encoders=$("$tools/evaluate_trajectory" "$out/truth.tum" "$out/encoder.tum")
python3 "$here/plot_trajectory.py" --reference "$out/truth.tum" --estimate "$out/online.tum" \
  --encoder "$out/encoder.tum" --out "$out/trajectory.png"
echo
echo "way driven                     $(echo "$estimate" | key path_m) m"
echo "error of the estimate (ATE)    $(echo "$estimate" | key ate_rmse_m) m"
echo "error of the encoders (ATE)    $(echo "$encoders" | key ate_rmse_m) m"
echo "poses per second               $(sed -n 's/.*poses_per_second=//p' "$out/roslaunch.log")"
echo "map                            $out/map.yaml, $out/map.pgm"
echo "picture                        $out/trajectory.png"
