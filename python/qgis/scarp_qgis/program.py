# SPDX-License-Identifier: MIT
"""The program `scarp`: where it is, what it offers, and its runs."""

import json
import os
import re
import select
import shutil
import signal
import subprocess
import time

#: Name of the setting of Processing that holds the path of the program.
SETTING = "SCARP_PROGRAM"

# Seconds between looks at the cancel button, and until the program is asked again, by force in the end. It stops at once
# when it is asked a second time.
_POLL, _PATIENCE = 0.05, 0.1

# The line that a terminal shows: "shadow 0...10...20".
_PROGRESS = re.compile(r"^[^:]* (?:\d+\.{3})*(\d+)(\.{0,3})$")


class ProgramError(Exception):
    """One line: what is wrong, and what to do."""


def find_program(path=""):
    """Returns the path of the program: that of the setting, else from PATH. Throws ProgramError."""
    found = shutil.which(path or "scarp")
    if found:
        return found
    where = f"'{path}' is not a program" if path else "the program 'scarp' is not installed"
    raise ProgramError(
        f"{where} (install the package scarp, or set its path in Settings > Options > Processing > Providers > Scarp)"
    )


def subcommands(program):
    """Returns the subcommands of the program by name, each with its options. Throws ProgramError."""
    try:
        done = subprocess.run([program, "options", "--json"], capture_output=True, timeout=30, check=True)
        return {one["name"]: one for one in json.loads(done.stdout)["subcommands"]}
    except (OSError, subprocess.SubprocessError, ValueError, KeyError, TypeError):
        raise ProgramError(f"{program}: does not describe its options (install the version of this plugin)") from None


def percent_of(line):
    """Returns the percentage that a line of progress has reached, None for other lines. A dot is 2.5 %."""
    found = _PROGRESS.match(line)
    return int(found[1]) + 2.5 * len(found[2]) if found else None


class _Stream:
    """Lines of one output of the program."""

    def __init__(self, descriptor):
        self.descriptor = descriptor
        self._rest = b""

    def read(self):
        """Returns new complete lines, the line that is being written, and whether the end was reached."""
        try:
            new = os.read(self.descriptor, 65536)
        except OSError:  # the end of a terminal
            new = b""
        *lines, self._rest = (self._rest + new).replace(b"\r", b"").split(b"\n")
        if not new and self._rest:
            lines, self._rest = [*lines, self._rest], b""
        return [line.decode(errors="replace") for line in lines], self._rest.decode(errors="replace"), not new


def _terminal():
    """Returns both ends of a terminal, on which the program shows its progress; a pipe where there are none."""
    try:
        return os.openpty()
    except (AttributeError, OSError):
        return os.pipe()


def _stop(process):
    """Ends the program within half a second. It removes its unfinished files unless it must be killed."""
    for number in (signal.SIGTERM, signal.SIGTERM, signal.SIGTERM):
        process.send_signal(number)
        try:
            process.wait(_PATIENCE)
            return
        except subprocess.TimeoutExpired:
            pass
    process.kill()
    process.wait()


def run(words, feedback):
    """Runs the program until it ends or is cancelled; cancelled runs return False. Throws ProgramError.

    Notes and results become messages of the feedback, progress its percentage.
    """
    reader, writer = _terminal()
    try:
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=writer)
    except OSError as error:
        os.close(reader)
        raise ProgramError(f"{words[0]}: {error.strerror}") from None
    finally:
        os.close(writer)
    streams = [_Stream(process.stdout.fileno()), _Stream(reader)]
    error = ""
    try:
        while streams:
            if feedback.isCanceled():
                _stop(process)
                return False
            ready, _, _ = select.select([s.descriptor for s in streams], [], [], _POLL)
            for stream in [s for s in streams if s.descriptor in ready]:
                lines, begun, ended = stream.read()
                for line in lines:
                    if line.startswith("scarp: error: "):
                        error = line[len("scarp: error: ") :]
                    elif percent_of(line) is None and line:
                        feedback.pushInfo(line)
                reached = percent_of(begun)
                if reached is not None:
                    feedback.setProgress(reached)
                if ended:
                    streams.remove(stream)
        while process.poll() is None and not feedback.isCanceled():
            time.sleep(_POLL)
        if process.poll() is None:
            _stop(process)
            return False
    finally:
        os.close(reader)
        process.stdout.close()
        if process.poll() is None:
            _stop(process)
    if process.returncode != 0:
        raise ProgramError(error or f"scarp: ended with status {process.returncode}")
    feedback.setProgress(100)
    return True
