"""A Slurm cluster of one node in a folder of its own: munged, slurmctld and slurmd on free ports of the loopback, with
their own key, socket, configuration and state, without accounting and cgroups. It neither reads nor changes a Slurm of
the system, and does not need root.

    with slurm_cluster.SlurmCluster() as cluster:
        subprocess.run(["sbatch", ...], env=cluster.environment)

It ends what it started, also after an error or ^C: orphans become children of this process, which knows its children.
If this process itself is killed by SIGKILL, the daemons end with it, but running jobs continue to their end, and the
folder remains."""
import ctypes
import getpass
import os
import pathlib
import signal
import socket
import subprocess
import tempfile
import time

import program

PROGRAMS = ("munged", "mungekey", "slurmctld", "slurmd", "sbatch", "scancel", "srun", "sinfo", "squeue", "scontrol")
PATH = os.environ["PATH"] + ":/usr/sbin:/sbin"
CONFIGURATION = pathlib.Path(__file__).with_name("slurm.conf.in")
_prctl = ctypes.CDLL(None).prctl
DEATH_SIGNAL, SUBREAPER = 1, 36


def missing():
    """The required programs that are missing."""
    return [name for name in PROGRAMS if not any(os.access(os.path.join(folder, name), os.X_OK)
                                                 for folder in PATH.split(":"))]


def free_ports(count):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [own.getsockname()[1] for own in sockets]
    for own in sockets:
        own.close()
    return ports


def wait_for(what, condition, seconds=60):
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            raise TimeoutError(what)
        time.sleep(0.2)


def children():
    """The process ids of this process's children, including orphans that it inherited."""
    return [process for process, (_, parent, _) in program.statuses().items() if parent == os.getpid()]


class SlurmCluster:
    def __enter__(self):
        _prctl(SUBREAPER, 1, 0, 0, 0)
        self.before = children()
        try:
            self.begin()
        except (OSError, RuntimeError):  # another process took a port between the query and the start of listening
            self.begin()
        return self

    def begin(self):
        """Starts the cluster, or stops it again with an error that shows the logs."""
        self.daemons = []
        self.temporary = tempfile.TemporaryDirectory(prefix="slurm_")
        self.folder = pathlib.Path(self.temporary.name)
        try:
            self.start()
        except BaseException as error:
            told = self.logs()
            self.stop()
            if not isinstance(error, Exception):
                raise
            raise RuntimeError(f"no Slurm cluster: {error}\n{told}") from error

    def __exit__(self, *_):
        self.stop()

    def start(self):
        self.folder.chmod(0o711)  # munged requires that all users can reach its socket
        for name, mode in (("munge", 0o711), ("state", 0o700), ("spool", 0o755)):
            (self.folder / name).mkdir()
            (self.folder / name).chmod(mode)
        controller_port, node_port = free_ports(2)
        configuration = self.folder / "slurm.conf"
        configuration.write_text(CONFIGURATION.read_text().format(folder=self.folder, user=getpass.getuser(),
                                                                  controller_port=controller_port, node_port=node_port))
        self.environment = {name: value
                            for name, value in os.environ.items() if not name.startswith(("SLURM", "SBATCH", "SRUN"))}
        self.environment.update(PATH=PATH, SLURM_CONF=str(configuration), USER=getpass.getuser())
        munge = self.folder / "munge"
        subprocess.run(["mungekey", "--create", f"--keyfile={munge}/key"], check=True, env=self.environment)
        self.daemon("munged", "--foreground", "--force", f"--key-file={munge}/key", f"--socket={munge}/socket",
                    f"--pid-file={munge}/pid", f"--log-file={munge}/log", f"--seed-file={munge}/seed",
                    "--num-threads=2")
        wait_for("munged's socket", (munge / "socket").exists)
        self.daemon("slurmctld", "-D", "-f", configuration)
        self.daemon("slurmd", "-D", "-N", "localhost", "-f", configuration)
        wait_for("an idle node", self.is_idle)

    def is_idle(self):
        ended = [daemon.args[0] for daemon in self.daemons if daemon.poll() is not None]
        if ended:
            raise RuntimeError(f"{ended[0]} ended")
        return self.told("sinfo", "-h", "-o", "%T").strip() == "idle"

    def daemon(self, *command):
        with open(self.folder / f"{command[0]}.out", "w", encoding="utf-8") as log:
            self.daemons.append(subprocess.Popen([str(part) for part in command], stdin=subprocess.DEVNULL, stdout=log,
                                                 stderr=log, start_new_session=True, env=self.environment,
                                                 preexec_fn=lambda: _prctl(DEATH_SIGNAL, signal.SIGTERM, 0, 0, 0)))

    def told(self, *command):
        return subprocess.run(command, capture_output=True, text=True, env=self.environment, timeout=60).stdout

    def logs(self):
        return "\n".join(f"{path.name}: {path.read_text()[-2000:]}" for path in sorted(self.folder.glob("*.out")))

    def stop(self):
        """Ends the jobs first, then the daemons, then their remaining processes."""
        if len(self.daemons) == 3:
            try:
                self.told("scancel", "--user", getpass.getuser())
                wait_for("an empty queue", lambda: not self.told("squeue", "-h").strip(), 20)
            except (TimeoutError, subprocess.TimeoutExpired):
                pass
        for daemon in reversed(self.daemons):
            daemon.terminate()
            try:
                daemon.wait(15)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        for process in set(children()) - set(self.before):
            try:
                os.kill(process, signal.SIGKILL)
                os.waitpid(process, 0)
            except (ProcessLookupError, ChildProcessError):
                pass
        self.temporary.cleanup()
