# A minimal Debian or Ubuntu in a folder, for scripts that set `program` to their name and source this. Needs root and
# debootstrap.

# fail MESSAGE [CODE]: ends the script.
fail() {
  echo "$program: $1" >&2
  exit "${2-1}"
}

# need_chroot: ends with 77, the code of a skipped test, where none can be made.
need_chroot() {
  ((EUID == 0)) || fail "skipped: needs root" 77
  command -v debootstrap >/dev/null || fail "skipped: debootstrap is not installed (apt-get install debootstrap)" 77
}

# system_here: the code name of this machine's system.
system_here() { (. /etc/os-release && echo "$VERSION_CODENAME"); }

# distribution_of SYSTEM: debian or ubuntu.
distribution_of() {
  case $1 in
    bookworm | trixie) echo debian ;;
    noble) echo ubuntu ;;
    *) fail "$1: no such system; known are bookworm, trixie and noble" 2 ;;
  esac
}

# mirror_of SYSTEM: $SIXDOF_MIRROR, or where this machine's apt has its own packages from if that has SYSTEM's, too.
mirror_of() {
  local mirror=${SIXDOF_MIRROR-} here
  if [[ -z $mirror && $(. /etc/os-release && echo "$ID") == $(distribution_of "$1") ]]; then
    here=$(system_here)
    mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' "Codename: $here" | head -n 1)
    [[ -n $mirror ]] || fail "apt knows no mirror of $here; run apt-get update"
  fi
  [[ -n $mirror ]] || fail "skipped: no mirror of $1 is known; SIXDOF_MIRROR names one" 77
  echo "$mirror"
}

# make_system SYSTEM FOLDER: a minimal one with the settings of this machine's apt.
make_system() {
  local distribution components=main script= mirror file
  distribution=$(distribution_of "$1")
  mirror=$(mirror_of "$1")
  if [[ $distribution == ubuntu ]]; then components=main,universe; fi
  if [[ ! -e /usr/share/debootstrap/scripts/$1 ]]; then # newer than this debootstrap: as its relatives are made
    script=/usr/share/debootstrap/scripts/sid
    if [[ $distribution == ubuntu ]]; then script=/usr/share/debootstrap/scripts/gutsy; fi
  fi
  debootstrap --variant=minbase --components="$components" "$1" "$2" "$mirror" ${script:+"$script"}
  for file in apt.conf apt.conf.d auth.conf auth.conf.d; do
    if [[ -e /etc/apt/$file ]]; then cp -a "/etc/apt/$file" "$2/etc/apt/"; fi
  done
  cp /etc/resolv.conf /etc/hosts "$2/etc/"
  # Certificates that this machine trusts beside Debian's: ca-certificates takes them up as it is installed.
  mkdir -p "$2/usr/local/share/ca-certificates"
  find /usr/local/share/ca-certificates -name '*.crt' -exec cp {} "$2/usr/local/share/ca-certificates/" \; 2>/dev/null || true
}

# inside FOLDER COMMAND...: in that system, with nothing of this environment but its way to the network.
inside() {
  local root=$1 name kept=()
  shift
  for name in http_proxy https_proxy no_proxy npm_config_registry NODE_EXTRA_CA_CERTS PIP_CERT; do
    if [[ -n ${!name-} ]]; then kept+=("$name=${!name}"); fi
  done
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "${kept[@]}" \
    chroot "$root" "$@"
}

# in_name_space ARGUMENT...: runs this script again, as `$0 --root $root ARGUMENT...`, in a name space of its own, so that
# what it mounts is gone when it ends, however it ends; then ends. Goes on in the inner run. Without `root` that is a folder
# for temporary files, removed at the end.
in_name_space() {
  if [[ ${SIXDOF_IN_NAME_SPACE-} == yes ]]; then return; fi
  local keep=true status=0
  if [[ -z $root ]]; then root=$(mktemp -d) keep=false; fi
  SIXDOF_IN_NAME_SPACE=yes unshare --mount --propagation private "$0" --root "$root" "$@" || status=$?
  if ! $keep; then rm -rf --one-file-system "$root"; fi
  exit "$status"
}

# clone_last_commit: of `here`, as sixdof in `root`. Sets `commit`, and begins steps.txt there.
clone_last_commit() {
  commit=$(git -C "$here" rev-parse --short=12 HEAD)
  rm -rf "$root/sixdof"
  git clone --quiet --no-hardlinks "$here" "$root/sixdof"
  chown -R root:root "$root/sixdof" # git refuses folders of others
  : >"$root/steps.txt"
}

failed=false
# step COMMAND...: runs it in the clone; its output goes to steps.txt, and its end to the screen if it fails: then `failed`
# is true, and its code 1.
step() {
  local begin=$SECONDS result=ok
  if ! inside "$root" sh -c 'cd /sixdof && exec "$@"' sh "$@" >>"$root/steps.txt" 2>&1; then
    result=FAILED failed=true
    tail -n 40 "$root/steps.txt"
  fi
  printf '%-6s %4d min  %s\n' "$result" $(((SECONDS - begin + 30) / 60)) "$*"
  [[ $result == ok ]]
}
