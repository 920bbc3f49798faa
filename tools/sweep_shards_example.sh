#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs one campaign serially, under GNU parallel, mpirun and a Slurm array of this machine, and
# holds the merged results against the serial ones, byte by byte.
# Usage: tools/sweep_shards_example.sh [SIMULATOR [SAMPLES]]
set -euo pipefail
cd "$(dirname "$0")/.."
simulator=$(realpath "${1:-build/release/tools/simulator}")
samples=${2:-40}
place=$(mktemp -d)
as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)

missing=()
for package in parallel openmpi-bin slurm-wlm munge; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  echo "Installing: ${missing[*]}" >&2
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2
fi

export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
sweep=("$simulator" sweep diagrams/static_test.yaml --samples "$samples" --seed 1 --no-progress
  -s expect.min_distance.at_least=-9 -s expect.final_error.at_most=9
  --vary parameters.avoidance=report,safety_filter
  --vary 'parameters.test_obstacle_height=uniform(0.8, 1.2)')

compare() {
  "$simulator" merge "$place/$1" --jsonl "$place/$1.jsonl" > "$place/$1.txt"
  cmp "$place/serial/results.jsonl" "$place/$1.jsonl"
  echo "$1: the same $(wc -c < "$place/$1.jsonl") bytes as the serial run"
}

"${sweep[@]}" -j 1 -o "$place/serial"

parallel -j 2 "${sweep[@]@Q}" -j 1 -o "$place/parallel" --shard '{}/3' ::: 0 1 2 > /dev/null
compare parallel

mpirun -np 2 --oversubscribe "${sweep[@]}" -j 1 -o "$place/mpirun" > /dev/null
compare mpirun

# A Slurm of one node, for this script alone: its own configuration, state and ports.
slurm=$place/slurm
mkdir -p "$slurm/state" "$slurm/spool"
if [ ! -e /run/munge/munge.socket.2 ]; then
  [ -e /etc/munge/munge.key ] || "${as_root[@]}" /usr/sbin/mungekey
  "${as_root[@]}" mkdir -p /run/munge
  "${as_root[@]}" chown munge: /run/munge /etc/munge/munge.key
  if [ "$(id -u)" -eq 0 ]; then
    setpriv --reuid=munge --regid=munge --clear-groups /usr/sbin/munged
  else
    sudo -u munge /usr/sbin/munged
  fi
fi
cat > "$slurm/slurm.conf" << EOF
ClusterName=example
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SlurmctldPort=26817
SlurmdPort=26818
StateSaveLocation=$slurm/state
SlurmdSpoolDir=$slurm/spool
SlurmctldPidFile=$slurm/slurmctld.pid
SlurmdPidFile=$slurm/slurmd.pid
SlurmctldLogFile=$slurm/slurmctld.log
SlurmdLogFile=$slurm/slurmd.log
ReturnToService=2
NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$(hostname -s) Default=YES MaxTime=INFINITE State=UP
EOF
export SLURM_CONF=$slurm/slurm.conf
stop() {
  for daemon in slurmd slurmctld; do
    [ ! -e "$slurm/$daemon.pid" ] || "${as_root[@]}" kill "$(cat "$slurm/$daemon.pid")" || true
  done
}
trap stop EXIT
"${as_root[@]}" env SLURM_CONF="$SLURM_CONF" slurmctld
"${as_root[@]}" env SLURM_CONF="$SLURM_CONF" slurmd
sbatch --wait --array=0-2 --output="$slurm/%a.log" --wrap="${sweep[*]@Q} -j 1 -o $place/slurm_array"
compare slurm_array
echo "results in $place"
