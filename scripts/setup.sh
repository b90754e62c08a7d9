#!/usr/bin/env bash
# Installs what the package needs from the distribution: Debian 12, or Ubuntu 20.04 with ROS Noetic's
# package source. Does nothing where everything is there already.
#   scripts/setup.sh            to build and run
#   scripts/setup.sh --test     and to run all tests and checks
set -euo pipefail

with_tests=false
[ "${1:-}" = "--test" ] && with_tests=true

debian_packages=(
  # build
  catkin cmake g++ ninja-build ccache
  libboost-dev libceres-dev libcli11-dev libeigen3-dev libopencv-dev libyaml-cpp-dev
  nlohmann-json3-dev zlib1g-dev
  libcv-bridge-dev libdiagnostic-msgs-dev libdiagnostic-updater-dev
  libdynamic-reconfigure-config-init-mutex-dev libimage-transport-dev libmap-msgs-dev
  libmessage-filters-dev libnav-msgs-dev libnodelet-dev libnodeletlib-dev librosbag-dev
  libroscpp-dev librostest-dev librviz-dev libsensor-msgs-dev libstd-srvs-dev libtf2-dev
  libtf2-msgs-dev libtf2-ros-dev libvisualization-msgs-dev pluginlib-dev qtbase5-dev
  # message definitions, which the libraries above only recommend
  ros-actionlib-msgs ros-diagnostic-msgs ros-geometry-msgs ros-map-msgs ros-message-generation
  ros-message-runtime ros-nav-msgs ros-roscpp-msg ros-rosgraph-msgs ros-sensor-msgs ros-std-msgs
  ros-std-srvs ros-tf2-msgs ros-visualization-msgs
  # run
  libnodeletlib-tools python3-dynamic-reconfigure
  python3-rosbag python3-roslaunch python3-rosmsg python3-rosnode python3-rosparam
  python3-rosservice python3-rostopic rosbash rosout rospack-tools rviz
  python3-diagnostic-msgs python3-geometry-msgs python3-map-msgs python3-nav-msgs
  python3-rosgraph-msgs python3-sensor-msgs python3-std-msgs python3-std-srvs python3-tf2-msgs
  python3-visualization-msgs python3-roslib
  python3-matplotlib python3-numpy
)
debian_test_packages=(
  catkin-lint catkin-tools clang clang-format clang-tidy git imagemagick libbenchmark-dev
  libclang-rt-dev libgl1-mesa-dri
  libgtest-dev libgmock-dev python3-numpy python3-opencv python3-rospkg python3-rospy
  python3-rostest python3-yaml xvfb x11-utils
)
ubuntu_packages=(
  cmake g++ ninja-build ccache
  libboost-dev libceres-dev libcli11-dev libeigen3-dev libopencv-dev libyaml-cpp-dev
  nlohmann-json3-dev qtbase5-dev zlib1g-dev
  ros-noetic-catkin ros-noetic-cv-bridge ros-noetic-diagnostic-msgs ros-noetic-diagnostic-updater
  ros-noetic-dynamic-reconfigure ros-noetic-image-transport ros-noetic-nodelet ros-noetic-pluginlib
  ros-noetic-map-msgs ros-noetic-message-filters ros-noetic-nav-msgs ros-noetic-rosbag
  ros-noetic-roscpp ros-noetic-roslaunch ros-noetic-rosbash ros-noetic-rostest ros-noetic-rviz
  ros-noetic-sensor-msgs ros-noetic-std-srvs ros-noetic-tf2 ros-noetic-tf2-msgs ros-noetic-tf2-ros
  ros-noetic-visualization-msgs
  python3-matplotlib python3-numpy
)
ubuntu_test_packages=(
  catkin-lint python3-catkin-tools clang clang-format clang-tidy git imagemagick libbenchmark-dev
  libgl1-mesa-dri libgtest-dev libgmock-dev python3-opencv python3-rospkg python3-yaml xvfb x11-utils
)

. /etc/os-release
case "${ID:-}:${VERSION_ID:-}" in
  debian:12)
    packages=("${debian_packages[@]}")
    $with_tests && packages+=("${debian_test_packages[@]}") ;;
  ubuntu:20.04)
    packages=("${ubuntu_packages[@]}")
    $with_tests && packages+=("${ubuntu_test_packages[@]}") ;;
  *)
    echo "setup.sh: ${PRETTY_NAME:-this system} is not known; Debian 12 and Ubuntu 20.04 are." >&2
    echo "Install what the script lists by hand, and build with catkin." >&2
    exit 1 ;;
esac

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' ||
    missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || {
    echo "setup.sh: run as root, or install sudo; missing are: ${missing[*]}" >&2
    exit 1
  }
  root=(sudo)
fi
echo "setup.sh: installing ${#missing[@]} packages"
export DEBIAN_FRONTEND=noninteractive
"${root[@]}" apt-get update -qq
if [ "$ID" = ubuntu ] && ! apt-cache show ros-noetic-roscpp >/dev/null 2>&1; then
  echo "setup.sh: apt does not know ROS Noetic; add its package source first" >&2
  echo "(see 'Ubuntu install of ROS Noetic' in the ROS wiki)." >&2
  exit 1
fi
"${root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
