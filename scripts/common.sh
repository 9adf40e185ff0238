# shellcheck shell=bash disable=SC2034  # the groups of packages are used by name
# Shell functions that the scripts share. Sourced by bash scripts that run with `set -euo pipefail`.
#
# Two roads lead to ROS 1, and what is found decides: where there is a /opt/ros/noetic it is used, and rosdep installs
# what package.xml names; elsewhere Debian's own packages of ROS are installed with apt.

# Another python3 in front of the system's (pyenv, conda) has no ROS modules, and ROS workspaces or compiler settings of
# the calling shell must not mix with this build.
export PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
unset PYTHONHOME PYTHONPATH LD_LIBRARY_PATH CMAKE_PREFIX_PATH ROS_PACKAGE_PATH ROS_MASTER_URI ROS_NAMESPACE
if [ -n "${CONDA_PREFIX:-}" ]; then unset CC CXX CFLAGS CXXFLAGS CPPFLAGS LDFLAGS; fi

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)  # CMake keeps no symbolic link either
noetic=/opt/ros/noetic
# Where it is built, with which options of CMake; a script may say otherwise before it builds.
build=$root/build
devel=$root/devel
cmake_options=()
cli11_url=https://github.com/CLIUtils/CLI11/releases/download/v2.1.2/CLI11.hpp

build_packages=(
  g++ make cmake pkg-config catkin ros-message-generation libroscpp-dev librosbag-dev librosbag-storage-dev
  ros-std-msgs ros-geometry-msgs ros-actionlib-msgs libactionlib-dev libdiagnostic-updater-dev libros-rosgraph-msgs-dev
  libdynamic-reconfigure-config-init-mutex-dev python3-dynamic-reconfigure libstd-srvs-dev ros-std-srvs
  libtf2-ros-dev libtf2-geometry-msgs-dev libtf2-msgs-dev ros-tf2-msgs libvisualization-msgs-dev ros-visualization-msgs
  libboost-dev libeigen3-dev libyaml-cpp-dev libcli11-dev nlohmann-json3-dev libode-dev
  libmuparser-dev libnlopt-cxx-dev
)
run_packages=(
  rosbash python3-roslaunch python3-rospy python3-rostopic python3-rosnode python3-rosservice python3-rosmsg
  python3-rosbag python3-rosparam python3-rospkg python3-yaml tf2-tools python3-matplotlib
  python3-std-msgs python3-std-srvs python3-geometry-msgs python3-tf2-msgs python3-visualization-msgs
  python3-actionlib python3-actionlib-msgs
)
rviz_packages=(rviz librviz-dev qtbase5-dev)
# with a virtual screen, and OpenGL without a graphics card
test_packages=(
  librostest-dev python3-rostest python3-diagnostic-msgs libgtest-dev libgmock-dev
  "${rviz_packages[@]}" xvfb xauth libgl1-mesa-dri
  ros-robot-state-publisher liburdfdom-tools
)

say() { printf '\n==> %s\n' "$*"; }
note() { printf '    %s\n' "$*"; }
die() { printf '\nerror: %s\n' "$*" >&2; exit 1; }

on_noetic() { [ -f "$noetic/setup.bash" ]; }

# Ends with the words of $1 unless there is a way to be root; asks for sudo's password where it wants one.
require_root() {
  [ "$(id -u)" -eq 0 ] || { command -v sudo >/dev/null && sudo -v; } || die "$1"
}

# Runs a command as root: directly, or with sudo.
as_root() {
  if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

# Prints those of the packages that are not installed.
missing_packages() {
  local package
  for package in "$@"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)" = installed ] ||
      printf '%s\n' "$package"
  done
}

# Installs those of the packages that are missing, with apt.
install_packages() {
  local missing
  mapfile -t missing < <(missing_packages "$@")
  if [ ${#missing[@]} -eq 0 ]; then
    note "everything is there"
    return
  fi
  note "missing: ${missing[*]}"
  require_root "installing needs root or sudo. As root, run: apt-get install -y --no-install-recommends ${missing[*]}"
  mkdir -p "$root/build/logs"
  local log="$root/build/logs/apt.log"
  note "installing with apt-get, which takes some minutes; its messages go to ${log#"$root"/}"
  if ! { as_root apt-get update || true;  # a broken source need not matter
         as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}"; } \
       >"$log" 2>&1 </dev/null; then
    tail -n 20 "$log" >&2
    die "apt-get could not install them (see above)"
  fi
  note "installed"
}

# roslaunch ends where the name localhost means nothing, as in a system fresh from debootstrap.
name_localhost() {
  if ! getent ahostsv4 localhost >/dev/null; then
    note "nothing tells the address of localhost, which ROS asks for: adding it to /etc/hosts"
    require_root "/etc/hosts needs the line: 127.0.0.1 localhost"
    echo "127.0.0.1 localhost" | as_root tee -a /etc/hosts >/dev/null
  fi
}

# Brings everything that the given groups of packages hold: install_dependencies build run [test] [rviz]
install_dependencies() {
  say "Looking for the packages that are needed to: $(printf '%s, ' "$@" | sed 's/, $//; s/rviz/show (rviz)/')"
  name_localhost
  if on_noetic; then
    note "ROS Noetic is in $noetic: rosdep installs what package.xml names"
    install_with_rosdep
    return
  fi
  command -v apt-get >/dev/null || die "no $noetic and no apt-get: this script knows Debian 12 and ROS Noetic only"
  local group packages=()
  for group in "$@"; do
    local -n group_packages="${group}_packages"
    packages+=("${group_packages[@]}")
  done
  install_packages "${packages[@]}"
}

install_with_rosdep() {
  install_packages python3-rosdep python3-matplotlib curl
  [ -e /etc/ros/rosdep/sources.list.d/20-default.list ] || as_root rosdep init
  rosdep update --rosdistro=noetic >/dev/null
  # Ubuntu 20.04 has no package of CLI11, a library of headers only.
  rosdep install --from-paths "$root" --ignore-src --rosdistro=noetic --skip-keys cli11 -y
  if [ ! -e /usr/include/CLI/CLI.hpp ] && [ ! -e "$root/build/cli11/CLI/CLI.hpp" ]; then
    note "fetching CLI11 into build/cli11"
    mkdir -p "$root/build/cli11/CLI"
    curl --fail --silent --show-error --location --output "$root/build/cli11/CLI/CLI.hpp" "$cli11_url"
  fi
}

# Sources a ROS setup file, which is not written for `set -u`.
source_setup() {
  set +u
  # shellcheck disable=SC1090
  . "$1"
  set -u
}

# As many compilers at once as there are processors and memory for (1.5 GB each).
parallel_jobs() {
  local processors memory
  processors=$(nproc)
  memory=$(awk '/^MemAvailable:/ { print int($2 / 1500000) }' /proc/meminfo 2>/dev/null || true)
  if [ -n "$memory" ] && [ "$memory" -lt "$processors" ]; then processors=$memory; fi
  printf '%s\n' $((processors > 0 ? processors : 1))
}

# Configures and builds the given targets in $build, with the devel space in $devel, and enters that space. What is
# installed goes to $build/.install: in a folder of the package that is not hidden roslaunch finds each launch file once
# more, and starts none. Starting anew leaves what has been measured and searched: files .csv and .jsonl in $build.
build_targets() {
  local cache="$build/CMakeCache.txt" options=("${cmake_options[@]}")
  say "Building in ${build#"$root"/}/ and ${devel#"$root"/}/ ($*; some minutes the first time)"
  if [ -f "$cache" ] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$cache"; then
    note "${build#"$root"/}/ is that of another directory: starting anew"
    find "$build/" -mindepth 1 -maxdepth 1 ! -name '*.csv' ! -name '*.jsonl' -exec rm -rf {} +
    rm -rf "$devel"
  fi
  if on_noetic; then source_setup "$noetic/setup.bash"; fi
  if [ -e "$root/build/cli11" ]; then options+=("-DCLI11_INCLUDE_DIR=$root/build/cli11"); fi
  mkdir -p "$build/logs"
  run_logged "$build/logs/configure.log" cmake -S "$root" -B "$build" -DCATKIN_DEVEL_PREFIX="$devel" \
    -DCMAKE_INSTALL_PREFIX="$build/.install" "${options[@]}"
  local log="$build/logs/build.log"
  if ! cmake --build "$build" -j "$(parallel_jobs)" --target "$@" 2>&1 | tee "$log" | show_progress; then
    grep -A 8 -m 5 -E 'error|Error' "$log" >&2 || true
    die "the build failed (see above, and all of it in ${log#"$root"/})"
  fi
  source_setup "$devel/setup.bash"
  use_local_ros
}

# Passes on of what make says that which tells how far it is, and warnings.
show_progress() { sed -n -u -E '/^\[ *[0-9]+%\] (Building CXX|Linking)|warning:/p'; }

# Runs a command with its messages in a file; shows the end of them if it fails.
run_logged() {
  local log=$1
  shift
  if ! "$@" >"$log" 2>&1; then
    tail -n 40 "$log" >&2
    die "$1 failed (see above, and all of it in ${log#"$root"/})"
  fi
}

# ROS on this computer alone, whatever its name resolves to; its logs go below $build.
use_local_ros() {
  export ROS_IP=127.0.0.1 ROS_HOME="$build/ros_home" ROS_LOG_DIR="$build/ros_home/log"
  unset ROS_HOSTNAME
  mkdir -p "$ROS_LOG_DIR"
}
