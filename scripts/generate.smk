# SPDX-License-Identifier: MIT
# Makes a set by Snakemake, or continues one that is not complete:
#
#   snakemake -s scripts/generate.smk --cores 8 --config campaign=CAMPAIGN.toml \
#     set=DIR tasks=16 [devices=N] [threads=2] [beamgyro=PROGRAM]
#
# Each task is a job, on this host or by any profile of Snakemake on hosts that
# share DIR. The last rule merges the manifest and verifies the set. The marks
# of finished tasks stand in DIR.tasks.
import os
import shlex

for key in ("campaign", "set", "tasks"):
    if key not in config:
        raise WorkflowError(f"--config {key}=... is missing")
CAMPAIGN = os.path.abspath(config["campaign"])
SET = os.path.abspath(config["set"])
TASKS = int(config["tasks"])
DEVICES = f"--devices {int(config['devices'])}" if "devices" in config else ""
PROGRAM = config.get("beamgyro", "beamgyro")
GENERATE = (f"{shlex.quote(PROGRAM)} --quiet generate {shlex.quote(CAMPAIGN)}"
            f" -o {shlex.quote(SET)} {DEVICES}")


rule whole:
    input:
        expand(f"{SET}.tasks/{{task}}-of-{TASKS}", task=range(1, TASKS + 1)),
    output:
        touch(f"{SET}.tasks/whole"),
    params:
        generate=f"{GENERATE} --shard 1/{TASKS}",
        verify=f"{shlex.quote(PROGRAM)} verify {shlex.quote(SET)}",
    shell:
        "{params.generate} && {params.verify}"


rule task:
    input:
        CAMPAIGN,
    output:
        touch(f"{SET}.tasks/{{task}}-of-{TASKS}"),
    params:
        generate=GENERATE,
    threads: int(config.get("threads", 1))
    shell:
        f"{{params.generate}} --shard {{wildcards.task}}/{TASKS}"
        " --jobs {threads}"
