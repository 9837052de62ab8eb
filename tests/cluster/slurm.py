#!/usr/bin/env python3
"""Runs what `relevo plan --slurm` writes under Slurm itself, on this one computer and without systemd, and compares the
tiles with those of one process: two tasks, one killed and requeued, one that fails three times.

Usage: slurm.py RELEVO DEM FOLDER [--parallel]. The folder is emptied first. Needs root and the packages slurm-wlm
and munge; with --parallel the package parallel alone, and lines for it are run instead. Ends with status 77 where it
cannot run, and says why.
"""

import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import time

SKIPPED = 77
LIMIT_S = 60
CONF = """
ClusterName=test
SlurmctldHost={host}
SlurmctldPort={ctld_port}
SlurmdPort={d_port}
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=4
CredType=cred/munge
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmdSpoolDir={folder}/spool
StateSaveLocation={folder}/state
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerType=sched/builtin
SchedulerParameters=batch_sched_delay=0,sched_interval=1,sched_min_interval=0,requeue_delay=0
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
KillWait=1
MessageTimeout=10
NodeName={host} CPUs={cpus} RealMemory=16000 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def run(*words, environment=None, check=True):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, env=environment, check=False)
    if check and done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return done


def free_port():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return taken.getsockname()[1]


def wait_for(what, until, is_done):
    while not is_done():
        if time.monotonic() > until:
            sys.exit(f"not within {LIMIT_S} s: {what}")
        time.sleep(0.2)


def tiles(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.glob("r*.tif"))}


class Slurm:
    """munged, slurmctld and slurmd in a folder of their own, as root."""

    def __init__(self, folder):
        self.folder = folder
        self.processes = []
        host = socket.gethostname().split(".")[0]
        (folder / "slurm.conf").write_text(CONF.format(host=host, folder=folder, ctld_port=free_port(),
                                                       d_port=free_port(), cpus=os.cpu_count()))
        (folder / "cgroup.conf").write_text("CgroupAutomount=no\n")
        (folder / "munge.key").write_bytes(os.urandom(128))
        (folder / "munge.key").chmod(0o400)
        for name in ("state", "spool"):
            (folder / name).mkdir()
        self.environment = dict(os.environ, SLURM_CONF=str(folder / "slurm.conf"))

    def start(self, until):
        at = self.folder
        self.begin("munged", "--foreground", "--force", f"--key-file={at}/munge.key", f"--socket={at}/munge.socket",
                   f"--pid-file={at}/munge.pid", f"--log-file={at}/munge.log", f"--seed-file={at}/munge.seed")
        wait_for("munged", until, (at / "munge.socket").exists)
        self.begin("slurmctld", "-D", "-f", at / "slurm.conf")
        self.begin("slurmd", "-D", "-f", at / "slurm.conf")
        wait_for(f"a node; see {at}/slurmd.log", until,
                 lambda: "idle" in self.call("sinfo", "-h", "-o", "%t", check=False).stdout)

    def begin(self, *words):
        self.processes.append(subprocess.Popen([str(word) for word in words], env=self.environment,
                                               stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                               stderr=subprocess.DEVNULL))

    def call(self, *words, check=True):
        return run(*words, environment=self.environment, check=check)

    def states(self, job):
        """Of the tasks of a job, by the names of scontrol."""
        shown = self.call("squeue", "-h", "-r", "-t", "all", "-j", job, "-o", "%K %T", check=False).stdout
        return dict(line.split() for line in shown.splitlines() if len(line.split()) == 2)

    def stop(self):
        for process in reversed(self.processes):
            process.send_signal(signal.SIGTERM)
        for process in self.processes:
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()


def hours(dem, folder, step):
    return ["sun", "hours", dem, "--date", "2026-12-21", "--tz", "UTC", "--step", step, "--tiles", 101, "-o", folder]


def plan(relevo, dem, folder, step, *more):
    return run(relevo, "plan", *hours(dem, folder, step), "--cpus", 1, "--memory", 64, *more)


def split_into(script, tasks):
    """So little work makes one task: the script is made to have more of them, as a plan of more work has."""
    text = script.read_text()
    script.write_text(text.replace("--array=1-1\n", f"--array=1-{tasks}\n").replace("_ID/1\"", f"_ID/{tasks}\""))


def check_parallel(relevo, dem, folder):
    lines = folder / "tasks it's.txt"
    plan(relevo, dem, folder / "out", 10, "--parallel", lines)
    line = lines.read_text()
    lines.write_text("".join(line.replace("--shard 1/1", f"--shard {task}/7") for task in range(1, 8)))
    run("parallel", "--will-cite", "-j", 2, "-a", lines)
    run(relevo, "merge", folder / "out")
    return tiles(folder / "out")


def check_tasks(slurm, relevo, dem, folder, tasks, until):
    script, out = folder / f"submit {tasks}.sh", folder / f"out {tasks}"
    plan(relevo, dem, out, 10, "--slurm", script)
    split_into(script, tasks)
    said = slurm.call("sh", script, f"--output={folder}/%x_%A_%a.log").stdout.split()
    job, merge = said[1], said[3]
    wait_for(f"{tasks} tasks", until, lambda: slurm.states(merge).get("N/A") == "COMPLETED")
    if not (out / "mosaic.vrt").exists():
        sys.exit("the merge has made no VRT")
    return job, tiles(out)


def check_killed(slurm, relevo, dem, folder, until):
    """A task is requeued while it runs: it goes on where it was."""
    script, out = folder / "killed.sh", folder / "killed"
    plan(relevo, dem, out, 1, "--slurm", script)
    job, _, merge = slurm.call("sh", script, f"--output={folder}/%x_%A_%a.log").stdout.split()[1:]
    wait_for("some tiles", until, lambda: len(tiles(out)) >= 2)
    if slurm.states(job).get("1") != "RUNNING":
        sys.exit("the task has ended too early to be killed")
    before = {name: (out / name).stat().st_mtime_ns for name in tiles(out)}
    slurm.call("scontrol", "requeue", f"{job}_1")
    wait_for("the requeued task", until, lambda: slurm.states(merge).get("N/A") == "COMPLETED")
    if any((out / name).stat().st_mtime_ns != when for name, when in before.items()):
        sys.exit("a tile that was there was made again")
    return tiles(out)


def check_failing(slurm, relevo, dem, folder, until):
    """A task fails three times: the merge does not run, and names what is missing when it is run by hand."""
    script, out = folder / "failing.sh", folder / "failing"
    plan(relevo, dem, out, 10, "--slurm", script)
    split_into(script, 2)
    tries = folder / "tries"
    text = script.read_text()
    text = text.replace("status=$?\n", f"status=$?\n[ $SLURM_ARRAY_TASK_ID = 1 ] || {{ echo >> '{tries}'; "
                                       f"rm -f '{out}/r0003_c0001.tif'; status=1; }}\n")
    script.write_text(text)
    said = slurm.call("sh", script, f"--output={folder}/%x_%A_%a.log").stdout.split()
    wait_for("three tries", until, lambda: slurm.states(said[1]).get("2") == "FAILED")
    if tries.read_text() != "\n" * 3:
        sys.exit(f"expected three tries but there were {len(tries.read_text())}")
    wait_for("the merge to be given up", until, lambda: slurm.states(said[3]).get("N/A") in ("CANCELLED", None))
    merge = run(relevo, "merge", out, check=False)
    if merge.returncode != 1 or "r0003_c0001.tif: is missing" not in merge.stderr:
        sys.exit(f"the merge does not name what is missing: {merge.stderr}")


def main():
    relevo, dem, folder = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
    only_parallel = "--parallel" in sys.argv
    for program in ["parallel"] if only_parallel else ["munged", "slurmctld", "slurmd", "sbatch"]:
        if not shutil.which(program):
            skip(f"{program} is not installed")
    if not only_parallel and os.geteuid() != 0:
        skip("Slurm's daemons need root here")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    until = time.monotonic() + LIMIT_S
    run(relevo, *hours(dem, folder / "one", 10))
    expected = tiles(folder / "one")
    if only_parallel:
        if check_parallel(relevo, dem, folder) != expected:
            sys.exit("the tiles of GNU parallel are others than those of one process")
        print(f"{len(expected)} tiles of 7 tasks are those of one process")
        return
    slurm = Slurm(folder)
    try:
        slurm.start(until)
        for tasks in (1, 2, 7):
            _, made = check_tasks(slurm, relevo, dem, folder, tasks, until)
            if made != expected:
                sys.exit(f"the tiles of {tasks} tasks are others than those of one process")
        killed = check_killed(slurm, relevo, dem, folder, until)
        run(relevo, *hours(dem, folder / "slow", 1))
        if killed != tiles(folder / "slow"):
            sys.exit("the tiles of a killed task are others than those of one process")
        check_failing(slurm, relevo, dem, folder, until)
    finally:
        slurm.stop()
    print(f"{len(expected)} tiles of 1, 2 and 7 tasks, and of a killed one, are those of one process")


if __name__ == "__main__":
    main()
