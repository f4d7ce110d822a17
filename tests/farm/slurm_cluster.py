# SPDX-License-Identifier: Apache-2.0
"""A Slurm cluster of two nodes on this machine, with daemons, ports, keys and folders of its own. Needs root."""
import os
import shutil
import signal
import socket
import subprocess
import time

PROGRAMS = "munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol"

# Seconds, on a machine that may be busy.
PATIENCE = 300

CONFIG = """\
ClusterName=vmlight
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
SlurmctldPort={ports[0]}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CryptoType=crypto/munge
StateSaveLocation={folder}/state
SlurmctldPidFile={folder}/slurmctld.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdSpoolDir={folder}/%n
SlurmdPidFile={folder}/%n.pid
SlurmdLogFile={folder}/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
SchedulerParameters=sched_interval=1,bf_interval=1,batch_sched_delay=0
KillWait=2
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs=1 RealMemory=500
NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs=1 RealMemory=500
PartitionName=bake Nodes=ALL Default=YES State=UP
"""


def missing():
    """Why there can be no cluster here, or ""."""
    absent = [program for program in PROGRAMS if not shutil.which(program)]
    return "not installed: " + ", ".join(absent) if absent else "" if os.geteuid() == 0 else "needs root"


def free_ports(count):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


class Cluster:
    def __init__(self, folder):
        self.folder = folder
        os.makedirs(self.path("state"))
        with open(self.path("munge.key"), "wb") as key:
            key.write(os.urandom(128))
        os.chmod(self.path("munge.key"), 0o400)
        with open(self.path("slurm.conf"), "w") as config:
            config.write(CONFIG.format(folder=folder, host=socket.gethostname().split(".")[0], ports=free_ports(3)))
        self.environment = {**os.environ, "SLURM_CONF": self.path("slurm.conf")}
        try:
            self.run("munged", "--force", "--socket", self.path("munge.socket"), "--key-file", self.path("munge.key"),
                     "--pid-file", self.path("munged.pid"), "--log-file", self.path("munged.log"), "--seed-file",
                     self.path("munge.seed"))
            self.run("slurmctld", "-c")
            for node in "n1", "n2":
                self.start(node)
            self.wait(lambda: self.run("sinfo", "-h", "-o", "%T").split() == ["idle"])
        except BaseException:
            self.stop()
            raise

    def path(self, name):
        return os.path.join(self.folder, name)

    def run(self, *words):
        return subprocess.run(words, check=True, text=True, env=self.environment, stdout=subprocess.PIPE,
                              timeout=60).stdout

    def wait(self, condition):
        until = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > until:
                raise TimeoutError(self.run("squeue") + self.run("sinfo"))
            time.sleep(0.1)

    def start(self, node):
        self.run("slurmd", "-N", node)

    def processes(self, node=None):
        """The numbers and names of the processes that the cluster, or a node of it, has started."""
        found = {}
        for number in filter(str.isdigit, os.listdir("/proc")):
            try:
                with open(f"/proc/{number}/environ", "rb") as file:
                    variables = file.read().split(b"\0")
                with open(f"/proc/{number}/comm") as file:
                    name = file.read().strip()
            except OSError:
                continue  # it has ended
            if b"SLURM_CONF=" + self.path("slurm.conf").encode() not in variables:
                continue
            if node is None or b"SLURMD_NODENAME=" + node.encode() in variables:
                found[int(number)] = name
        return found

    def pid(self, daemon):
        with open(self.path(daemon + ".pid")) as file:
            return int(file.read())

    def crash(self, node):
        """As if it lost its power: all that runs on it is gone. Slurm hears of it at once."""
        tasks = self.processes(node)
        parents = {parent(number) for number in tasks} - {0, *tasks}  # which would report how their tasks ended
        for number in [self.pid(node), *parents, *tasks]:
            kill(number)
        self.run("scontrol", "update", f"nodename={node}", "state=down", "reason=crashed")

    def stop(self):
        for daemon in "n1", "n2", "slurmctld", "munged":
            try:
                os.kill(self.pid(daemon), signal.SIGTERM)
            except (OSError, ValueError):
                pass
        time.sleep(0.5)
        for number in self.processes():
            kill(number)


def parent(number):
    """The number of its parent; 0 if it has ended."""
    try:
        with open(f"/proc/{number}/stat") as file:
            return int(file.read().rpartition(")")[2].split()[1])
    except OSError:
        return 0


def kill(number):
    """Whether there was such a process."""
    try:
        os.kill(number, signal.SIGKILL)
    except ProcessLookupError:
        return False
    return True
