# A Slurm cluster of three nodes on this machine, with its own keys, ports and folder; it does not
# touch an installed Slurm. test.sh sources this file and sets $work.

started=no

start_slurm() {
  [ "$(id -u)" = 0 ] || { echo "error: Slurm's daemons need root" >&2; exit 2; }
  if ! command -v slurmctld slurmd sbatch munged > /dev/null; then
    apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq slurmctld slurmd slurm-client munge > /dev/null
  fi
  slurm=$work/slurmd
  mkdir -p "$slurm/state"
  export SLURM_CONF=$slurm/slurm.conf
  write_configuration > "$SLURM_CONF"
  (umask 077 && head -c 1024 /dev/urandom > "$slurm/key")
  started=yes
  munged --key-file="$slurm/key" --socket="$slurm/munge" --pid-file="$slurm/munged.pid" \
    --log-file="$slurm/munged.log" --seed-file="$slurm/seed" --force
  slurmctld -f "$SLURM_CONF"
  local node
  for node in n1 n2 n3; do slurmd -N "$node" -f "$SLURM_CONF"; done
  until_true nodes_are_idle
}

nodes_are_idle() { [ "$(sinfo -h -N -t idle 2> /dev/null | wc -l)" = 3 ]; }

write_configuration() {
  local host port node
  host=$(hostname -s)
  port=$((20000 + $$ % 12000))
  cat <<END
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmUser=root
AuthType=auth/munge
# This is also the delay of a task that is queued again, usually two minutes.
AuthInfo=socket=$slurm/munge,cred_expire=5
StateSaveLocation=$slurm/state
SlurmctldPidFile=$slurm/slurmctld.pid
SlurmctldLogFile=$slurm/slurmctld.log
SlurmdSpoolDir=$slurm/%n
SlurmdPidFile=$slurm/%n.pid
SlurmdLogFile=$slurm/%n.log
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
# Seconds until Slurm notices a dead node.
SlurmdTimeout=10
# Start tasks immediately instead of every two seconds.
SchedulerParameters=sched_min_interval=100000,bf_interval=2
PartitionName=all Nodes=n1,n2,n3 Default=YES MaxTime=INFINITE State=UP
END
  for node in 1 2 3; do
    echo "NodeName=n$node NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + node)) CPUs=8 RealMemory=8192"
  done
}

# Lists the processes of this cluster, that is its daemons and their tasks. All have the cluster's
# configuration in their environment.
processes() {
  local environment
  for environment in /proc/[0-9]*/environ; do
    if grep -qsz "^SLURM_CONF=$SLURM_CONF$" "$environment"; then echo "${environment//[!0-9]/}"; fi
  done
}

# Kills a node as a power failure would: its daemon, the task, and the process that supervises the
# task.
kill_node() {
  local process pids
  pids=$(cat "$slurm/$1.pid")
  for process in $(processes); do
    if grep -qsz "^SLURMD_NODENAME=$1$" "/proc/$process/environ"; then
      pids="$pids $process $(ps -o ppid= -p "$process" | grep -vx ' *1' || true)"
    fi
  done
  # shellcheck disable=SC2086
  kill -9 $pids
}

stop_slurm() {
  [ "$started" = yes ] || return 0
  scontrol shutdown > /dev/null 2>&1 || true
  sleep 1
  local process
  for process in $(processes); do kill -9 "$process" 2> /dev/null || true; done
}
