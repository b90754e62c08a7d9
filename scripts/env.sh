# To be sourced by the other scripts: the programs of the distribution come first, whatever else is
# installed, because another python3 breaks catkin and the ROS tools.
export PATH=/usr/bin:/usr/sbin:/bin:/sbin
unset PYTHONPATH PYTHONHOME
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
if [ -f /opt/ros/noetic/setup.bash ]; then
  # Within a function without arguments, as the set-up file would take the script's for its own.
  load_ros() { set +u && . /opt/ros/noetic/setup.bash && set -u; }
  load_ros
fi
# Two processes of the compiler fit into the memory of small machines.
jobs=$(nproc)
