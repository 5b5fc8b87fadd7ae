# SPDX-License-Identifier: MIT
"""The job array of examples/slurm, with a program in place of sbatch that sets the variables which SLURM sets."""

import os
import subprocess

import numpy as np
import pytest
from conftest import hills

SBATCH = """#!/bin/sh
# Runs a job or a job array at once, the tasks in reverse order, and prints the job's number and the cluster's name.
count=1
while :; do
  case $1 in
    --array=1-*) count=${1#--array=1-} ;;
    --parsable | --requeue | --job-name=* | --kill-on-invalid-dep=yes) ;;
    --dependency=afterok:7) ;;
    --*) echo "sbatch: unrecognized option '$1'" >&2; exit 1 ;;
    *) break ;;
  esac
  shift
done
task=$count
while [ $task -ge 1 ]; do
  SLURM_ARRAY_JOB_ID=7 SLURM_ARRAY_TASK_ID=$task SLURM_ARRAY_TASK_COUNT=$count SLURM_ARRAY_TASK_MIN=1 \\
    SLURM_ARRAY_TASK_MAX=$count "$@" >>jobs.log 2>&1 || exit 1
  task=$((task - 1))
done
echo "7;cluster"
"""


@pytest.fixture
def script():
    return os.path.join(os.environ["SCARP_SOURCE"], "examples/slurm/map_parts.sh")


def test_parts_of_a_job_array_are_one_map(script, scarp_program, tmp_path):
    np.save(tmp_path / "dem.npy", hills(70, 60))
    (tmp_path / "sbatch").write_text(SBATCH)
    (tmp_path / "sbatch").chmod(0o755)
    run = lambda *words: subprocess.run(
        words,
        cwd=tmp_path,
        capture_output=True,
        text=True,
        env={**os.environ, "PATH": f"{tmp_path}:{os.environ['PATH']}", "SCARP": scarp_program},
    )
    words = ("horizon", "dem.npy", "--azimuths", "4")
    assert run(scarp_program, *words, "-o", "whole.tif").returncode == 0
    done = run(script, "5", "out.tif", *words)
    assert done.returncode == 0, done.stderr + (tmp_path / "jobs.log").read_text()
    assert sorted(p.name for p in tmp_path.glob("*.tif*")) == ["out.tif", "whole.tif"]
    assert (tmp_path / "out.tif").read_bytes() == (tmp_path / "whole.tif").read_bytes()
    assert (tmp_path / "jobs.log").read_text().count("out.tif.part-") == 5


def test_wrong_use_has_one_line(script):
    for words in (), ("5", "out.tif"), ("none", "out.tif", "shadow", "dem.tif"), ("0", "out.tif", "shadow", "dem.tif"):
        done = subprocess.run([script, *words], capture_output=True, text=True)
        assert done.returncode == 2 and done.stderr.startswith("usage: ") and done.stderr.count("\n") == 1
