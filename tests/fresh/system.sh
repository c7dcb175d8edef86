# A bare Debian 12 in a folder, and commands inside it; as root, with mmdebstrap. Sourced by tests/fresh/run and .ci/run.

package_sources() {  # those of this machine that are Debian's own, as files; none: mmdebstrap asks Debian's servers
  grep -qs '^VERSION_CODENAME=bookworm' /etc/os-release || return 0
  grep -lsE '^deb .* bookworm(-updates|-security|/updates)? main|^Suites:.*bookworm' \
    /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/debian.sources
}

make_system() {  # folder, further packages (,name...): Debian's smallest set of packages
  local sources
  mapfile -t sources < <(package_sources)
  mmdebstrap --quiet --variant=minbase --include="ca-certificates${2-}" bookworm "$1" "${sources[@]}" >"$1.log" 2>&1 || {
    tail -n 5 "$1.log" >&2
    return 1
  }
  apt-config dump | grep -iE '^Acquire::[a-z:]*proxy' >"$1/etc/apt/apt.conf.d/99proxy"
  cp -L /etc/resolv.conf /etc/hosts "$1/etc/"
  echo force-unsafe-io >"$1/etc/dpkg/dpkg.cfg.d/scratch"  # nothing of it outlives a power cut
}

# Runs a command in the system, with processes and mounts of its own, which go when it ends. A folder of this machine
# that is shared has the same path inside. Variables of tests and of OpenBLAS go along.
inside() {  # system, folder inside, folder that is shared or nothing, command, arguments...
  local system=$1 at=$2 shared=$3 variable kept=()
  shift 3
  for variable in http_proxy https_proxy CI PYTEST_ADDOPTS $(compgen -e OPENBLAS_); do
    [ -z "${!variable+set}" ] || kept+=("$variable=${!variable}")
  done
  [ -z "$shared" ] || mkdir -p "$system$shared"
  unshare --mount --pid --fork --kill-child bash -c '
    system=$1 at=$2 shared=$3
    shift 3
    mount --bind "$system" "$system" && mount --rbind /dev "$system/dev" && mount -t proc proc "$system/proc" &&
      mount -t sysfs sysfs "$system/sys" && { [ -z "$shared" ] || mount --bind "$shared" "$system$shared"; } || exit 1
    exec chroot "$system" /usr/bin/env -i HOME=/root LANG=C.UTF-8 TERM=dumb PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"
  ' - "$system" "$at" "$shared" "${kept[@]}" bash -c 'cd "$1" && shift && exec "$@"' - "$at" "$@" </dev/null
}
