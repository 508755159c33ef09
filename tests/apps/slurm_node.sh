#!/usr/bin/env bash
# A Slurm cluster of one node for a test, everything it writes under one folder:
#   slurm_node.sh FOLDER PARENT
# Runs munged, slurmctld and slurmd until FOLDER/stop appears or the process PARENT is gone; then none of
# them is left. FOLDER/ready stands as soon as jobs can be submitted with SLURM_CONF=FOLDER/slurm.conf.
# Needs root, as slurmd does.
set -euo pipefail
folder="$1"
parent="$2"
mkdir -p "$folder"/{state,spool,log}
node="$(hostname -s)"

# Any ports, so that several tests may run on one machine; slurmd and slurmctld must know them before.
ports() {
  python3 -c 'import socket
s = [socket.socket() for _ in range(2)]
for one in s: one.bind(("127.0.0.1", 0))
print(*(one.getsockname()[1] for one in s))'
}
read -r controller_port node_port < <(ports)

cat >"$folder/slurm.conf" <<END
ClusterName=pushid
SlurmctldHost=$node(127.0.0.1)
SlurmctldPort=$controller_port
SlurmdPort=$node_port
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CredType=cred/munge
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
MinJobAge=300
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/log/slurmctld.log
SlurmdLogFile=$folder/log/slurmd.log
NodeName=$node NodeAddr=127.0.0.1 RealMemory=1000 CPUs=2 Sockets=1 CoresPerSocket=2 ThreadsPerCore=1 State=UNKNOWN
PartitionName=all Nodes=$node Default=YES MaxTime=INFINITE State=UP
END
head -c 128 /dev/urandom >"$folder/munge.key"
chmod 600 "$folder/munge.key"
export SLURM_CONF="$folder/slurm.conf"

daemons=()
stop() {
  trap - EXIT
  if [ -e "$folder/ready" ]; then timeout 5 scancel --signal=KILL --full --user=root 2>/dev/null || true; fi
  for ((i = ${#daemons[@]} - 1; i >= 0; --i)); do
    kill "${daemons[i]}" 2>/dev/null || true
    for _ in {1..30}; do kill -0 "${daemons[i]}" 2>/dev/null || break; sleep 0.1; done
    kill -KILL "${daemons[i]}" 2>/dev/null || true
  done
  wait || true
}
trap stop EXIT
trap 'exit 1' INT TERM

# Killed outright, this script takes them along.
start() {
  setpriv --pdeathsig KILL "$@" &
  daemons+=($!)
}
start munged --foreground --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" \
  --pid-file="$folder/munge.pid" --log-file="$folder/log/munge.log" --seed-file="$folder/munge.seed"
for _ in {1..50}; do [ -S "$folder/munge.socket" ] && break; sleep 0.1; done
start slurmctld -D -f "$SLURM_CONF"
start slurmd -D -f "$SLURM_CONF" -N "$node"

while [ ! -e "$folder/stop" ] && kill -0 "$parent" 2>/dev/null; do
  for daemon in "${daemons[@]}"; do
    kill -0 "$daemon" 2>/dev/null || { echo "a daemon ended; see $folder/log" >&2; exit 1; }
  done
  if [ ! -e "$folder/ready" ] && [ "$(timeout 5 sinfo -h -o %T 2>/dev/null || true)" = idle ]; then
    touch "$folder/ready"
  fi
  sleep 0.2
done
