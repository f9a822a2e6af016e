# SPDX-License-Identifier: MIT
"""Exported code on an emulated Cortex-M4 with single-precision hardware."""

import json
import re
import shutil
import subprocess
import unittest

import pytest

from exported import MODELS, WARNINGS, ExportTest
from program import ROOT

FIRMWARE = ROOT / "tests/firmware"
COMPILER, EMULATOR = "arm-none-eabi-gcc", "qemu-system-arm"
CORE = ["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16",
        "-O2"]
LINK = [FIRMWARE / "start.c", "-T", FIRMWARE / "mps2_an386.ld",
        "-nostartfiles", "--specs=rdimon.specs"]
# Of one step of the network 3-8-1, and of its code and parameters: without and
# with the sigma of its bias.
MOST_INSTRUCTIONS = {False: 400, True: 700}
MOST_BYTES = {False: 1850, True: 3200}


def missing():
    tools = [tool for tool in (COMPILER, EMULATOR) if shutil.which(tool) is None]
    if tools:
        return f"{' and '.join(tools)} missing"
    specs = subprocess.run([COMPILER, "-print-file-name=rdimon.specs"],
                           capture_output=True, text=True, check=True).stdout
    return "" if "/" in specs else "newlib for arm-none-eabi missing"


# export_test.py compiles and runs the same code for this machine in test.sh.
# Its bits, its instructions and its size on a Cortex-M4 are tested only here.
@pytest.mark.deep
@unittest.skipIf(missing(), missing())
class ExportFirmware(ExportTest):
    def emulate(self, folder, *options):
        return self.run_binary(
            EMULATOR, "-M", "mps2-an386", "-nographic", "-semihosting-config",
            "enable=on,target=native", *options, "-kernel", folder / "a.out")

    def test_every_kind_answers_to_the_last_bit_on_a_cortex_m4(self):
        for kind in MODELS:
            folder = self.export(kind)
            self.compile(folder, *WARNINGS, *CORE, "net.c",
                         "net_selftest.c", *LINK, compiler=COMPILER)
            self.assertEqual(self.emulate(folder),
                             "net: 10000 answers equal to the last bit\n")

    def networks(self):
        """Whether a network 3-8-1 states a sigma, and the folder of its code."""
        stored = json.loads((self.dir / self.train("3_8_1")).read_text())
        for sigma in [False, True]:
            text = stored if sigma else {
                key: value for key, value in stored.items() if key != "sigma"}
            self.assertEqual("sigma" in text, sigma)
            self.write("network.json", json.dumps(text))
            folder = self.dir / f"network_{sigma}"
            self.ok("export", "network.json", "--format", "c", "-o", folder,
                    "--name", "net", "--quiet")
            yield sigma, folder

    def test_step_of_a_3_8_1_network_takes_few_instructions(self):
        for sigma, folder in self.networks():
            self.compile(folder, *WARNINGS, *CORE, "-I.",
                         FIRMWARE / "instructions.c", *LINK, compiler=COMPILER)
            told = self.emulate(folder, "-icount", "shift=0")
            count = {what: int(number) for what, number in
                     re.findall(r"(\w+) (\d+)", told)}
            print(f"\n3-8-1 on a Cortex-M4, sigma {sigma}: "
                  f"{told.replace(chr(10), ', ')}", end="")
            # 49 products and 8 divisions
            self.assertLess(200, count["bias"])
            self.assertLess(count["bias"], count["step"])
            self.assertLessEqual(count["step"], MOST_INSTRUCTIONS[sigma])

    def test_code_and_parameters_of_a_3_8_1_network_are_small(self):
        for sigma, folder in self.networks():
            self.compile(folder, *WARNINGS, *CORE, "-ffunction-sections", "-c",
                         "net.c", compiler=COMPILER)
            listed = self.run_binary("arm-none-eabi-size", "-A",
                                     folder / "net.o")
            size = {name: int(number) for name, number in
                    re.findall(r"^(\.\S+)\s+(\d+)", listed, re.MULTILINE)}
            code = sum(bytes_ for name, bytes_ in size.items()
                       if name.startswith(".text"))
            constants = sum(bytes_ for name, bytes_ in size.items()
                            if name.startswith(".rodata"))
            print(f"\n3-8-1, sigma {sigma}: .text {code} (step "
                  f"{size['.text.net_step']}), constants {constants} bytes",
                  end="")
            self.assertLessEqual(code + constants, MOST_BYTES[sigma])
            self.assertEqual(size[".data"] + size[".bss"], 0)
