#!/bin/bash
# Power cuts: a run writes to a disk image, and the image is copied as it is on the way, with nothing flushed for it. That is what a disk holds when the power
# goes. Each copy is mounted; what has a receipt there must be whole, and the same command must end with the bytes of an undisturbed run.
#
#   tests/disk/power_cut.sh PROGRAM SPEC DIR COUNT
#
# Exit code 77: it cannot be tried here (it takes root, mkfs.ext4 and loop devices), and why.
set -Eeuo pipefail
trap 'echo "line $LINENO: exit code $?" >&2' ERR
program=$1 spec=$2 dir=$3 count=$4
disk=$dir/disk.img live=$dir/live cut=$dir/cut
missing() { echo "no power cut here: $1" >&2; exit 77; }
[ "$(id -u)" = 0 ] || missing "only root can mount"
export PATH=$PATH:/usr/sbin:/sbin
command -v mkfs.ext4 >/dev/null || missing "there is no mkfs.ext4"
mkdir -p "$live" "$cut"
truncate -s 200M "$disk"
mkfs.ext4 -q -F "$disk"
mount -o loop "$disk" "$live" 2>"$dir/mount.log" || missing "$(cat "$dir/mount.log")"
trap 'umount "$cut" 2>/dev/null || true; umount "$live" 2>/dev/null || true' EXIT
began=$(date +%s%N)
"$program" run "$spec" --out "$dir/whole" --jobs 1 >/dev/null 2>&1
long=$(($(date +%s%N) - began))
receipts=0
for number in $(seq "$count"); do
  rm -rf "$live/out"
  "$program" run "$spec" --out "$live/out" --jobs 1 >/dev/null 2>&1 &
  work=$!
  sleep "$(awk -v n="$number" -v long="$long" 'BEGIN { share = 0.618034 * n; print (share - int(share)) * long / 1e9 }')"
  cp --sparse=always "$disk" "$disk.cut"
  wait "$work"
  mount -o loop "$disk.cut" "$cut"
  if [ -f "$cut/out/campaign.toml" ]; then
    receipts=$((receipts + $(find "$cut/out/receipts" -name '*.json' | wc -l)))
    # Files of the task at which the power went have no receipt yet; every file that has one must be whole.
    "$program" verify "$cut/out" --deep --json >"$dir/audit.json" || true
    grep -q '"faults": \[\]' "$dir/audit.json" || { cat "$dir/audit.json"; echo "cut $number lost what had a receipt"; exit 1; }
  fi
  "$program" run "$spec" --out "$cut/out" --jobs 1 >/dev/null 2>&1
  diff -rq -x receipts -x '.hysteron-*' "$cut/out" "$dir/whole" || { echo "cut $number ends with other bytes"; exit 1; }
  umount "$cut"
done
echo "$count cuts, $receipts receipts"
