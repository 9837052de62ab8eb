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
AuthInfo=socket={folder}/munge.socket,cred_expire=5
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


def plan(relevo, *words):
    return run(relevo, "plan", *words)


def split_into(script, tasks):
    """So little work makes one task: the script is made to have more of them, as a plan of more work has."""
    text = script.read_text()
    script.write_text(text.replace("--array=1-1\n", f"--array=1-{tasks}\n").replace("_ID/1\"", f"_ID/{tasks}\""))


def check_parallel(relevo, dem, folder):
    lines = folder / "tasks it's.txt"
    plan(relevo, *hours(dem, folder / "out", 10), "--parallel", lines)
    line = lines.read_text()
    lines.write_text("".join(line.replace("--shard 1/1", f"--shard {task}/7") for task in range(1, 8)))
    run("parallel", "--will-cite", "-j", 2, "-a", lines)
    run(relevo, "merge", folder / "out")
    return tiles(folder / "out")


class Planned:
    """A command that Slurm does: its script, its results, and its jobs."""

    def __init__(self, slurm, relevo, script, tasks, *words):
        self.slurm = slurm
        self.script = script
        plan(relevo, *words, "--cpus", 1, "--memory", 64, "--slurm", script)
        split_into(script, tasks)

    def submit(self):
        said = self.slurm.call("sh", self.script, f"--output={self.script}.%a.log").stdout.split()
        self.job, self.merge = said[1], said[3]

    def state(self, task):
        return self.slurm.states(self.job).get(str(task))

    def is_merged(self):
        return self.slurm.states(self.merge).get("N/A") == "COMPLETED"


def fail_a_task(planned, tries, tile):
    """The second task ends with status 1, without one of its tiles."""
    text = planned.script.read_text()
    planned.script.write_text(text.replace("status=$?\n", f"status=$?\n[ $SLURM_ARRAY_TASK_ID = 1 ] || "
                                           f"{{ echo >> '{tries}'; rm -f '{tile}'; status=1; }}\n"))


def kill_a_task(slurm, planned, out, until):
    """Requeues a task while it runs. Returns when its tiles were made that were there."""
    wait_for("some tiles", until, lambda: len(list(out.glob("r*.tif"))) >= 2)
    if planned.state(1) != "RUNNING":
        sys.exit("the task has ended too early to be killed")
    there = {path: path.stat().st_mtime_ns for path in out.glob("r*.tif")}
    slurm.call("scontrol", "requeue", f"{planned.job}_1")
    return there


def job_of_pictures(dem, folder):
    job = folder / "job.json"
    job.write_text(f"""{{"format": 1, "dem": {{"files": ["{dem}"]}}, "picture": {{"size": [64, 48]}},
        "time": {{"at": "0:00", "date": "2026-06-21"}}, "effects": {{"only": []}},
        "sweep": [{{"times": {{"from": "8:00", "to": "19:00", "step": "2h"}}}}],
        "output": "{folder}/out/{{time:%H%M}}.png"}}""")
    return ["run", job, "--device", "software"]


def check_pictures(relevo, dem, folder):
    def made():
        return {path.name: path.read_bytes() for path in (folder / "out").glob("*.png")}

    of_tasks = made()
    run(relevo, *job_of_pictures(dem, folder), "--memory", 64, "--overwrite")
    if len(of_tasks) != 6 or of_tasks != made():
        sys.exit("pictures of tasks are others than those of one process")


def check_slurm(relevo, dem, folder, until):
    slurm = Slurm(folder)
    try:
        slurm.start(until)
        whole = {tasks: Planned(slurm, relevo, folder / f"submit {tasks}.sh", tasks,
                                *hours(dem, folder / f"out {tasks}", 10)) for tasks in (1, 2, 7)}
        killed = Planned(slurm, relevo, folder / "killed.sh", 1, *hours(dem, folder / "killed", 1))
        failing = Planned(slurm, relevo, folder / "failing.sh", 2, *hours(dem, folder / "failing", 10))
        (folder / "pictures").mkdir()
        pictures = Planned(slurm, relevo, folder / "pictures.sh", 2, *job_of_pictures(dem, folder / "pictures"))
        fail_a_task(failing, folder / "tries", folder / "failing/r0003_c0001.tif")
        for planned in (killed, failing):
            planned.submit()
        there = kill_a_task(slurm, killed, folder / "killed", until)
        for planned in (*whole.values(), pictures):
            planned.submit()
        for planned in (*whole.values(), pictures, killed):
            wait_for(f"{planned.script} and its merge", until, planned.is_merged)
        if any(path.stat().st_mtime_ns != when for path, when in there.items()):
            sys.exit("a tile that was there was made again")
        wait_for("three tries", until, lambda: failing.state(2) == "FAILED")
        wait_for("the merge to be given up", until,
                 lambda: slurm.states(failing.merge).get("N/A") in ("CANCELLED", None))
    finally:
        slurm.stop()
    if (folder / "tries").read_text() != "\n" * 3:
        sys.exit("expected three tries of the task that fails")


def check_results(relevo, dem, folder, expected):
    run(relevo, *hours(dem, folder / "slow", 1))
    for made, of in [(f"out {tasks}", expected) for tasks in (1, 2, 7)] + [("killed", tiles(folder / "slow"))]:
        if tiles(folder / made) != of or not (folder / made / "mosaic.vrt").exists():
            sys.exit(f"{made}: the tiles are others than those of one process, or there is no VRT")
    check_pictures(relevo, dem, folder / "pictures")
    merge = run(relevo, "merge", folder / "failing", check=False)
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
    check_slurm(relevo, dem, folder, until)
    check_results(relevo, dem, folder, expected)
    print(f"{len(expected)} tiles of 1, 2 and 7 tasks, and of a killed one, are those of one process")


if __name__ == "__main__":
    main()
