# Debian packages: what packages.txt lists, by group.

packages_of() {  # groups... -> names in packages.txt
  awk -v groups=" $* " '!/^#/ && NF && index(groups, " " $2 " ") { print $1 }' "$root/packages.txt"
}

only_missing() {  # names, a line each -> those that are not installed
  local names installed name
  mapfile -t names
  installed=" $(dpkg-query -W -f='${db:Status-Abbrev}${Package} ' "${names[@]}" 2>/dev/null)"
  for name in "${names[@]}"; do
    [[ $installed == *" ii $name "* || $installed == *" hi $name "* ]] || echo "$name"
  done
}

as_root() {
  if [ "$EUID" = 0 ]; then
    env DEBIAN_FRONTEND=noninteractive "$@"
  else
    sudo env DEBIAN_FRONTEND=noninteractive "$@"
  fi
}

apt_install() {  # options and names...
  as_root apt-get install -y --no-install-recommends -o DPkg::Lock::Timeout=600 "$@" \
    >>"$root/build/packages.log" 2>&1 </dev/null 9>&-
}

can_install() {
  command -v apt-get >/dev/null || fail "no apt-get here. Pliant installs itself on Debian 12 only; see packages.txt."
  [ "$EUID" = 0 ] || command -v sudo >/dev/null ||
    fail "Debian packages are missing and neither root nor sudo is there. As root: apt-get install $*"
}

update_lists_once() {
  [ -z "${lists_updated:-}" ] || return 0
  lists_updated=yes
  : >"$root/build/packages.log"
  # A broken third-party source must not stop us: what is missing shows when installing.
  as_root apt-get update -o DPkg::Lock::Timeout=600 >>"$root/build/packages.log" 2>&1 </dev/null 9>&-
}

install_needed() {  # group: stops when it cannot be installed
  local missing
  mapfile -t missing < <(packages_of "$1" | only_missing)
  [ ${#missing[@]} -gt 0 ] || return 0
  can_install "${missing[@]}"
  say "installing ${#missing[@]} Debian packages (log: build/packages.log)"
  update_lists_once
  apt_install "${missing[@]}" && return 0
  tail -n 15 "$root/build/packages.log" >&2
  fail "could not install: ${missing[*]}. Full log: $root/build/packages.log"
}

install_wanted() {  # packages: installed together, or left out where another one would have to go; whether they are
  local missing
  mapfile -t missing < <(printf '%s\n' "$@" | only_missing)
  [ ${#missing[@]} -gt 0 ] || return 0
  say "installing, if possible: ${missing[*]}"
  update_lists_once
  apt_install --no-remove "${missing[@]}" && return 0
  say "not installed: ${missing[*]}, as others would have to go (log: build/packages.log); going on"
  return 1
}

unpack() {  # folder below build/, packages: their files, without installing them
  local folder="$root/build/$1" part="$root/build/$1.part"
  [ ! -d "$folder" ] || return 0
  rm -rf "$part"
  mkdir -p "$part"
  say "unpacking them in build/$1 instead"
  (cd "$part" && apt-get download "${@:2}" &&
    for file in *.deb; do dpkg -x "$file" . || exit 1; done && rm ./*.deb) \
    >>"$root/build/packages.log" 2>&1 </dev/null 9>&- && mv "$part" "$folder"
}

# clang with its OpenMP, which cmake/compiler.cmake then finds.
install_fast_compiler() {
  local compiler openmp
  mapfile -t compiler < <(packages_of fast | grep -v '^libomp')
  mapfile -t openmp < <(packages_of fast | grep '^libomp')
  install_wanted "${compiler[@]}" && { install_wanted "${openmp[@]}" || unpack openmp "${openmp[@]}"; } && return 0
  say "g++ builds instead of clang-19: forces take 1.9 times as long"
}

ensure_packages() {
  local stamp="$root/build/packages.stamp"
  cmp -s "$root/packages.txt" "$stamp" && return 0
  install_needed required
  install_fast_compiler
  cp "$root/packages.txt" "$stamp"
}
