# SPDX-License-Identifier: MIT
"""Recipes that make a set by many tasks: Kubernetes and Snakemake."""

import os
import shutil
import subprocess

import pytest
import yaml

from program import PROGRAM, ROOT, SCENARIOS, said

SMALL = SCENARIOS / "campaigns/small.toml"
KUBERNETES = ROOT / "scripts/kubernetes_generate.sh"
SNAKEFILE = ROOT / "scripts/generate.smk"
DEVICES = 12  # three files


def contents(folder):
    return {path.relative_to(folder): path.read_bytes()
            for path in folder.rglob("*") if path.is_file()}


@pytest.fixture(scope="module", name="reference")
def make_reference(tmp_path_factory):
    folder = tmp_path_factory.mktemp("reference")
    said(PROGRAM, "generate", SMALL, "-o", "set", "--devices", DEVICES,
         cwd=folder)
    return contents(folder / "set")


def job(*options):
    text = said(KUBERNETES, "scenarios/campaigns/small.toml", "sets/small",
                "--image", "registry.example/beamgyro:1", "--claim", "sets",
                "--tasks", 2, "--devices", DEVICES, *options)
    return yaml.safe_load(text)


def test_the_job_of_kubernetes_is_indexed():
    found = job("--at-once", 1, "--cpus", 4)
    assert (found["apiVersion"], found["kind"]) == ("batch/v1", "Job")
    spec = found["spec"]
    assert spec["completionMode"] == "Indexed"
    assert (spec["completions"], spec["parallelism"]) == (2, 1)
    pod = spec["template"]["spec"]
    assert pod["restartPolicy"] == "OnFailure"
    assert pod["volumes"][0]["persistentVolumeClaim"]["claimName"] == "sets"
    container, = pod["containers"]
    assert container["volumeMounts"][0]["name"] == pod["volumes"][0]["name"]
    assert container["resources"]["requests"]["cpu"] == "4"


# Not in a cluster: the commands of its pods run here, with the variable that
# Kubernetes sets for each index.
def test_the_pods_of_kubernetes_make_the_set(tmp_path, reference):
    container, = job()["spec"]["template"]["spec"]["containers"]
    programs = tmp_path / "programs"
    programs.mkdir()
    (programs / "beamgyro").symlink_to(PROGRAM)
    data = tmp_path / "data"
    shutil.copytree(SCENARIOS, data / "scenarios")
    for index in (1, 0):
        subprocess.run(container["command"], check=True, cwd=data, env={
            **os.environ, "JOB_COMPLETION_INDEX": str(index),
            "PATH": f"{programs}:{os.environ['PATH']}"})
    assert contents(data / "sets/small") == reference


@pytest.mark.parametrize("arguments, words", [
    (("a.toml", "set"), "--image is missing"),
    (("a.toml", "set", "--image", "i"), "--claim is missing"),
    (("a.toml", "set", "--image", "i; rm"), "--image i; rm: expected"),
    (("a.toml", "set", "--tasks", "0"), "--tasks 0: expected a whole"),
    (("$(x)", "set", "--image", "i", "--claim", "c"), "expected a path in"),
    (("a.toml", "../set", "--image", "i", "--claim", "c"), "expected a path"),
    (("a.toml", "set", "--wrong", "1"), "unknown option --wrong"),
])
def test_what_is_wrong_in_a_job_is_said(arguments, words):
    found = subprocess.run([KUBERNETES, *arguments], capture_output=True,
                           text=True, check=False)
    assert found.returncode == 2 and words in found.stderr
    assert not found.stdout


# test.sh makes tasks of a set by hand (generate_test.py) and does not see
# whether Snakemake calls them so.
@pytest.mark.deep
@pytest.mark.skipif(not shutil.which("snakemake"), reason="no snakemake here")
def test_snakemake_makes_the_set(tmp_path, reference):
    def snakemake(*options):
        return subprocess.run(
            ["/usr/bin/snakemake", "-s", SNAKEFILE, "--cores", "2", "--config",
             f"campaign={SMALL}", "set=set", "tasks=2", f"devices={DEVICES}",
             f"beamgyro={PROGRAM}", *options], cwd=tmp_path, check=True,
            capture_output=True, text=True,
            env={**os.environ, "HOME": str(tmp_path)})
    said_before = snakemake("--dry-run").stdout
    assert "task" in said_before and not (tmp_path / "set").exists()
    snakemake()
    assert contents(tmp_path / "set") == reference
    again = snakemake()
    assert "Nothing to be done" in again.stdout + again.stderr
