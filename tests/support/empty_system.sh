#!/usr/bin/env bash
# empty_system.sh RELEASE FOLDER: runs ./reproduce and ./check as a new user does, in a fresh clone on an empty Debian
# RELEASE (bookworm, trixie), in a chroot that debootstrap makes below FOLDER. FOLDER/RELEASE keeps what they print and
# repeated.json. The exit status is that of the first that fails. It needs root, 10 GB of disk and an hour on two cores.
# The proxy of apt and the certificates are this machine's.
# shellcheck disable=SC2016  # $0 is for the inner shell
set -euo pipefail
release=$1 kept=$(realpath -m "$2/$1")
root=$kept/root
((EUID == 0)) || { echo "empty_system.sh: not root: only root can make a system with debootstrap" >&2; exit 2; }
rm -rf "$kept"
mkdir -p "$root"
trap 'rm -rf "$root"' EXIT
if ! debootstrap --variant=minbase "$release" "$root" >"$kept/debootstrap.txt" 2>&1; then
    tail -n 1 "$kept/debootstrap.txt" >&2
    exit 2
fi
cp -r /etc/apt/apt.conf.d "$root/etc/apt/"
cp /etc/ssl/certs/ca-certificates.crt "$root/certificates.crt"
git clone --quiet "$(realpath "$(dirname "$0")/../..")" "$root/root/pbskin"

# The mounts are in a namespace of their own, which ends with its processes: nothing of this machine is mounted when the
# folder is removed.
status=0
unshare --mount --pid --fork bash -euo pipefail -c '
    mount --bind /dev "$0/dev"
    mount -t proc proc "$0/proc"
    mount -t sysfs sys "$0/sys"
    exec chroot "$0" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
        NODE_EXTRA_CA_CERTS=/certificates.crt bash -c "cd ~/pbskin && ./reproduce && ./check"' "$root" |&
    tee "$kept/printed.txt" || status=$?
cp "$root/root/pbskin/results/reproduce/"{repeated.json,*.txt} "$kept/" || status=1
cp -r "$root/root/pbskin/results/check" "$kept/" || status=1
exit "$status"
