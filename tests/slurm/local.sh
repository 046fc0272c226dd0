#!/bin/bash
# A real Slurm of one node on this machine's loopback, for tests: no systemd, no accounting, everything below one folder.
#
#   tests/slurm/local.sh up DIR     install Debian's packages if they are missing, start the three daemons, wait for the node
#   tests/slurm/local.sh down DIR   cancel all jobs and end the daemons that `up` has started
#
# `up` prints the line that lets sbatch and squeue find it. Exit code 77: it cannot be had here, and why.
set -euo pipefail
verb=${1:-} dir=${2:-}
[ -n "$dir" ] || { sed -n 2,8p "$0" >&2; exit 2; }
conf=$dir/slurm.conf
export SLURM_CONF=$conf
export PATH=$PATH:/usr/sbin:/sbin

missing() { echo "no Slurm here: $1" >&2; exit 77; }

install() {
  command -v slurmctld >/dev/null && command -v slurmd >/dev/null && command -v munged >/dev/null && return
  [ "$(id -u)" = 0 ] || missing "it is not installed, and only root can install it"
  command -v apt-get >/dev/null || missing "it is not installed, and there is no apt-get"
  # Debian's packages would start their services, which needs an init; 101 forbids it.
  local policy=/usr/sbin/policy-rc.d own=
  [ -e $policy ] || { own=1; printf '#!/bin/sh\nexit 101\n' >$policy; chmod 755 $policy; }
  { apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends slurm-wlm munge; } >"$dir/install.log" 2>&1 || {
    [ -z "$own" ] || rm -f $policy
    missing "its packages cannot be installed, see $dir/install.log"
  }
  [ -z "$own" ] || rm -f $policy
}

configure() {
  local host memory
  host=$(hostname -s)
  memory=$(awk '/MemTotal/ {print int($2 / 1024 * 0.8)}' /proc/meminfo)
  mkdir -p "$dir"/{state,spool,log,run,key}
  chmod 755 "$dir" "$dir"/{state,spool,log,run}
  chmod 700 "$dir/key"
  [ -s "$dir/key/munge" ] || { head -c 1024 /dev/urandom >"$dir/key/munge"; chmod 400 "$dir/key/munge"; }
  cat >"$conf" <<END
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$dir/run/munge.sock
CredType=cred/munge
SlurmctldPort=16917
SlurmdPort=16918
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/run/slurmctld.pid
SlurmdPidFile=$dir/run/slurmd.pid
SlurmctldLogFile=$dir/log/slurmctld.log
SlurmdLogFile=$dir/log/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,bf_interval=1,sched_interval=1
MinJobAge=300
MaxArraySize=${MAX_ARRAY_SIZE:-1001}
KillWait=2
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=$memory State=UNKNOWN
PartitionName=main Nodes=$host Default=YES MaxTime=INFINITE DefMemPerCPU=200 State=UP
END
}

# A daemon that this script has started and that still runs. A zombie does not.
runs() {
  local pid
  pid=$(cat "$dir/run/$1.own" 2>/dev/null) && [ -r "/proc/$pid/stat" ] && ! grep -q ') Z ' "/proc/$pid/stat" && grep -q "$1" "/proc/$pid/comm"
}

start() {
  local name=$1
  shift
  runs "$name" && return
  setsid "$name" "$@" </dev/null >>"$dir/log/$name.out" 2>&1 &
  echo $! >"$dir/run/$name.own"
}

wait_for() {
  for _ in $(seq 300); do "$@" && return; sleep 0.1; done
  missing "it does not come up; see $dir/log"
}

idle() { case "$(sinfo -h -o %T 2>/dev/null || true)" in idle* | mixed* | allocated*) ;; *) return 1 ;; esac; }

case "$verb" in
up)
  mkdir -p "$dir"
  install
  configure
  start munged --foreground --force --key-file="$dir/key/munge" --seed-file="$dir/key/seed" --log-file="$dir/log/munged.log" \
    --pid-file="$dir/run/munged.pid" --socket="$dir/run/munge.sock"
  wait_for test -S "$dir/run/munge.sock"
  start slurmctld -D -f "$conf"
  start slurmd -D -f "$conf" -N "$(hostname -s)"
  wait_for idle
  echo "export SLURM_CONF=$conf"
  ;;
down)
  timeout 5 scancel --me 2>/dev/null || true
  for name in slurmd slurmctld munged; do
    runs $name || continue
    pid=$(cat "$dir/run/$name.own")
    kill "$pid" || true
    for _ in $(seq 100); do runs $name || break; sleep 0.1; done
    if runs $name; then kill -9 "$pid"; fi
    rm -f "$dir/run/$name.own"
  done
  ;;
*) sed -n 2,8p "$0" >&2; exit 2 ;;
esac
