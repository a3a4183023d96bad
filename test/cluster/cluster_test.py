#!/usr/bin/env python3
"""The job array of bench/slurm on a real Slurm: a controller and two nodes, started and ended on this machine.

usage: cluster_test.py SIXDOF SCRIPT

One task is killed with signal 9. Merging then fails, the task is requeued, and the merged set has the bytes of the one
that a single process makes. Exit code 77: Slurm is not installed.
"""
import os
import pathlib
import pwd
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "sinfo", "scontrol", "scancel")
SHARDS = 6
VICTIM = 3
# A shard takes a second or two: long enough to be killed before its end.
JOB = ("--a bumpy-sphere-500 --b torus-knot-1000 --grid 30 --volume-grid 30/90 --distances 0,20 --volumes 2").split()
START_S = 60.0  # for daemons to come up on a busy machine
WORK_S = 240.0  # for the array


class Skip(Exception):
    pass


def find_programs():
    path = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"  # an ordinary user's path may lack them
    found = {name: shutil.which(name, path=path) for name in PROGRAMS}
    missing = [name for name, place in found.items() if place is None]
    if missing:
        raise Skip(f"{', '.join(missing)}: not installed (cmake/setup cluster)")
    return found


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for s in sockets:
        s.bind(("127.0.0.1", 0))
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


def wait_for(what, seconds, condition):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        result = condition()
        if result:
            return result
        time.sleep(0.05)
    raise TimeoutError(f"{what}: not within {seconds:.0f} s")


class Slurm:
    """munged, slurmctld and two slurmd as this user, with all their files in one folder."""

    def __init__(self, folder, programs):
        self.folder = folder
        self.programs = programs
        self.user = pwd.getpwuid(os.getuid()).pw_name
        self.daemons = []
        self.environment = dict(os.environ, SLURM_CONF=str(folder / "slurm.conf"))

    def start(self):
        key = self.folder / "munge.key"
        key.touch(mode=0o600)
        key.write_bytes(os.urandom(128))
        munge = self.folder / "munge.socket"
        self.daemon("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={munge}",
                    f"--pid-file={self.folder}/munged.pid", f"--log-file={self.folder}/munged.log",
                    f"--seed-file={self.folder}/munged.seed")
        wait_for("munged", START_S, munge.exists)
        self.configure(munge)
        self.daemon("slurmctld", "-D", "-c")
        for node in ("n1", "n2"):
            self.daemon("slurmd", "-D", "-N", node)
        wait_for("two idle nodes", START_S, lambda: self.run("sinfo", "-h", "-o", "%T %D").strip() == "idle 2")

    def configure(self, munge):
        controller, *nodes = free_ports(3)
        host, user, folder = socket.gethostname(), self.user, self.folder
        (folder / "state").mkdir()
        # Control groups are not used. Without this line slurmd looks for their version and ends where none are mounted.
        (folder / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\n")
        # A requeued task waits for cred_expire.
        (folder / "slurm.conf").write_text(f"""ClusterName=sixdof
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={munge},cred_expire=5
StateSaveLocation={folder}/state
SlurmctldPidFile={folder}/slurmctld.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdSpoolDir={folder}/spool-%n
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmdLogFile={folder}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0,sched_interval=1,bf_interval=1
ReturnToService=2
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={nodes[0]} CPUs=1
NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={nodes[1]} CPUs=1
PartitionName=all Nodes=n1,n2 Default=YES State=UP
""")

    def daemon(self, name, *arguments):
        log = open(self.folder / f"{name}-{len(self.daemons)}.out", "w")
        self.daemons.append((name, subprocess.Popen([self.programs[name], *arguments], stdout=log, stderr=log,
                                                    stdin=subprocess.DEVNULL, env=self.environment)))

    def run(self, name, *arguments):
        done = subprocess.run([self.programs[name], *arguments], env=self.environment, capture_output=True, text=True)
        return done.stdout if done.returncode == 0 else ""

    def submit(self, *arguments):
        done = subprocess.run([self.programs["sbatch"], "--parsable", *arguments], env=self.environment, check=True,
                              capture_output=True, text=True, cwd=self.folder)
        return done.stdout.strip().split(";")[0]

    def tasks(self):
        """{task: state} of what is pending or running."""
        lines = self.run("squeue", "-h", "-r", "-o", "%K %T").split("\n")
        return dict(line.split() for line in lines if line)

    def processes_of(self, task, program):
        """Process ids of `program` within a task of this Slurm."""
        found = []
        for entry in pathlib.Path("/proc").iterdir():
            if not entry.name.isdigit():
                continue
            try:
                environment = (entry / "environ").read_bytes().split(b"\0")
                executable = os.readlink(entry / "exe")
            except OSError:
                continue
            if (executable == program and f"SLURM_ARRAY_TASK_ID={task}".encode() in environment
                    and f"SLURM_CONF={self.environment['SLURM_CONF']}".encode() in environment):
                found.append(int(entry.name))
        return found

    def logs(self):
        for log in sorted(self.folder.glob("*.out")) + sorted(self.folder.glob("*.log")):
            yield f"--- {log.name}\n{log.read_text(errors='replace')[-2000:]}"

    def stop(self):
        self.run("scancel", "--user", self.user)
        try:
            wait_for("an empty queue", 20.0, lambda: not self.tasks())
        except TimeoutError:
            pass
        for _, process in reversed(self.daemons):
            process.terminate()
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def check(truth, words):
    if not truth:
        raise AssertionError(words)


def run_array(slurm, sixdof, script, folder):
    whole, merged, shards = folder / "whole.h5", folder / "merged.h5", folder / "shards"
    alone = subprocess.run([script, str(shards), str(SHARDS), *JOB], capture_output=True, text=True)
    check(alone.returncode == 2 and "usage" in alone.stderr, "the script outside an array")
    subprocess.run([sixdof, "generate", *JOB, "--threads", "1", "-o", str(whole)], check=True)
    slurm.environment["SIXDOF"] = sixdof
    job = slurm.submit(f"--array=1-{SHARDS}", script, str(shards), str(SHARDS), *JOB)
    victim_file = shards / f"shard-{VICTIM:04}-of-{SHARDS:04}.h5"

    process = wait_for("the victim's process", WORK_S, lambda: slurm.processes_of(VICTIM, sixdof))[0]
    time.sleep(0.1)
    check(not victim_file.exists(), "the victim was to be killed before its end")
    os.kill(process, signal.SIGKILL)
    wait_for("the rest of the array", WORK_S, lambda: not slurm.tasks())
    check(not victim_file.exists(), f"{victim_file} of a killed task")
    made = sorted(shards.glob("shard-*.h5"))
    check(len(made) == SHARDS - 1, f"{len(made)} shards after the kill of one task")
    refused = subprocess.run([sixdof, "merge", str(shards), "-o", str(merged)], capture_output=True, text=True)
    check(refused.returncode != 0 and f"{victim_file}: missing" in refused.stderr, f"merge: {refused.stderr}")

    before = {path: path.stat().st_mtime_ns for path in made}
    check(subprocess.run([slurm.programs["scontrol"], "requeue", f"{job}_{VICTIM}"], env=slurm.environment).returncode
          == 0, "the task cannot be requeued")
    wait_for("the requeued task", WORK_S, lambda: victim_file.exists() and not slurm.tasks())
    check(before == {path: path.stat().st_mtime_ns for path in made}, "a finished shard was made again")
    subprocess.run([sixdof, "merge", str(shards), "-o", str(merged)], check=True)
    check(merged.read_bytes() == whole.read_bytes(), "the merged set differs from the single process's")
    check(not list(shards.glob(".*.partial")), "temporary files are left")
    print(f"killed process {process} of task {job}_{VICTIM}; requeued, merged: same {len(whole.read_bytes())} bytes")


def main():
    sixdof, script = (os.path.realpath(argument) for argument in sys.argv[1:3])
    try:
        programs = find_programs()
    except Skip as reason:
        print(f"skipped: {reason}")
        return SKIPPED
    with tempfile.TemporaryDirectory(prefix="sixdof-slurm-", dir="/tmp") as name:  # sockets want short paths
        slurm = Slurm(pathlib.Path(name), programs)
        try:
            slurm.start()
            run_array(slurm, sixdof, script, slurm.folder)
        except BaseException:
            print("\n".join(slurm.logs()))
            raise
        finally:
            slurm.stop()
    return 0


if __name__ == "__main__":
    sys.exit(main())
