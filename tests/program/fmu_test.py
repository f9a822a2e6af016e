# SPDX-License-Identifier: MIT
"""`fmu` of the shipped program: archives, model descriptions, their binary."""

import ctypes
import hashlib
import importlib.util
import unittest
import xml.etree.ElementTree as xml
import zipfile

from program import SCENARIOS, ProgramTest

NOMINAL = SCENARIOS / "devices/nominal.toml"
LIFELIKE = SCENARIOS / "devices/lifelike_with_modes.toml"
PLATFORM = {2: "linux64", 3: "x86_64-linux"}

# Elements and attributes of the schema that a description of this program may
# have; "!" marks what must be there.
VARIABLE = ("name! valueReference! description! causality! variability! "
            "initial")
NUMBER = "unit min max start"
SCHEMA = {
    2: {"fmiModelDescription": "fmiVersion! modelName! guid! description "
        "version generationTool variableNamingConvention",
        "CoSimulation": "modelIdentifier! "
        "canHandleVariableCommunicationStepSize canInterpolateInputs "
        "canNotUseMemoryManagementFunctions canGetAndSetFMUstate "
        "canSerializeFMUstate",
        "ScalarVariable": VARIABLE, "Real": NUMBER, "Integer": NUMBER,
        "Boolean": "start", "Outputs": "", "InitialUnknowns": "",
        "Unknown": "index!"},
    3: {"fmiModelDescription": "fmiVersion! modelName! instantiationToken! "
        "description version generationTool variableNamingConvention",
        "CoSimulation": "modelIdentifier! "
        "canHandleVariableCommunicationStepSize canGetAndSetFMUState "
        "canSerializeFMUState",
        "Float64": f"{VARIABLE} {NUMBER}", "Int32": f"{VARIABLE} {NUMBER}",
        "UInt64": f"{VARIABLE} {NUMBER}", "Boolean": f"{VARIABLE} start",
        "Output": "valueReference!", "InitialUnknown": "valueReference!"}}
BOTH = {"UnitDefinitions": "", "Unit": "name!",
        "BaseUnit": "kg m s A K mol rad factor offset",
        "LogCategories": "", "Category": "name!",
        "DefaultExperiment": "startTime stopTime stepSize",
        "ModelVariables": "", "ModelStructure": ""}
# Names by the grammar of structured naming.
PART = r"(?:[A-Za-z_]\w*|'[ -&(-\[\]-~]+')(?:\[\d+\])?"


class Fmu(ProgramTest):
    def made(self, fmi, device=NOMINAL, *words):
        self.ok("fmu", device, "--fmi", fmi, *words, "-o", "gyro.fmu")
        with zipfile.ZipFile(self.dir / "gyro.fmu") as archive:
            self.assertIsNone(archive.testzip())
            self.names = archive.namelist()
            archive.extractall(self.dir / "gyro")
        return xml.parse(self.dir / "gyro/modelDescription.xml").getroot()

    def variables(self, root):
        """(attributes with those of its type, name of the type) of each."""
        for element in root.find("ModelVariables"):
            if element.tag == "ScalarVariable":
                kind, = element
                yield element.attrib | kind.attrib, kind.tag
            else:
                yield element.attrib, element.tag

    def test_an_archive_has_what_the_standard_asks(self):
        for fmi in (2, 3):
            root = self.made(fmi, LIFELIKE, "--set", "readout.adc_bits=18",
                             "--set", "beam.length_m=0.041")
            self.assertEqual(self.names, [
                "modelDescription.xml",
                f"binaries/{PLATFORM[fmi]}/beamgyro_fmu.so",
                "resources/device.toml", "resources/overrides.txt",
                "resources/fidelity.txt"])
            text = (self.dir / "gyro/resources/device.toml").read_bytes()
            changes = b"readout.adc_bits=18\nbeam.length_m=0.041"
            self.assertEqual(text, LIFELIKE.read_bytes())
            self.assertEqual(
                (self.dir / "gyro/resources/overrides.txt").read_bytes(),
                changes)
            token = root.get("guid" if fmi == 2 else "instantiationToken")
            self.assertEqual(
                token, hashlib.sha256(text + b"\n" + changes +
                                      b"\nquasistatic").hexdigest())
            starts = {v["name"]: v.get("start")
                      for v, _ in self.variables(root)}
            self.assertEqual(starts["readout.adc_bits"], "18")
            self.assertEqual(float(starts["beam.length_m"]), 0.041)
            self.assertEqual(float(starts["patches.offset_m[2]"]), -5e-6)

    def test_equal_inputs_make_equal_bytes(self):
        for name in ("a.fmu", "b.fmu"):
            self.ok("fmu", NOMINAL, "-o", name)
        self.assertSameBytes("a.fmu", "b.fmu")

    def test_descriptions_keep_to_the_schema(self):
        for fmi in (2, 3):
            for element in self.made(fmi, LIFELIKE).iter():
                allowed = {**SCHEMA[fmi], **BOTH}[element.tag].split()
                self.assertLessEqual(
                    {*element.attrib}, {name.rstrip("!") for name in allowed})
                for name in allowed:
                    if name.endswith("!"):
                        self.assertIn(name[:-1], element.attrib)

    def test_descriptions_keep_to_the_rules(self):
        for fmi in (2, 3):
            root = self.made(fmi, LIFELIKE)
            variables = [*self.variables(root)]
            for key in ("name", "valueReference"):
                self.assertEqual(len({v[key] for v, _ in variables}),
                                 len(variables))
            units = {unit.get("name") for unit in root.iter("Unit")}
            used = {v["unit"] for v, _ in variables if "unit" in v}
            self.assertEqual(units, used)
            for v, kind in variables:
                self.assertRegex(v["name"], rf"^{PART}(?:\.{PART})*$")
                given = v["causality"] in ("input", "parameter")
                self.assertEqual("start" in v, given)
                self.assertEqual(
                    v.get("initial"), "calculated"
                    if v["causality"] in ("output", "local") else None)
                if v["variability"] == "continuous":
                    self.assertIn(kind, ("Real", "Float64"))
                if given and kind not in ("Boolean",):
                    self.assertLessEqual(float(v.get("min", "-inf")),
                                         float(v["start"]))
                    self.assertGreaterEqual(float(v.get("max", "inf")),
                                            float(v["start"]))
            self.assertEqual([v["name"] for v, _ in variables
                              if v["causality"] == "independent"], ["time"])
            outputs = [v for v, _ in variables if v["causality"] == "output"]
            self.assertEqual(
                [v["name"] for v in outputs],
                ["output", "rate", "temperature", "drive_frequency",
                 "drive_voltage", "quadrature", "status"])
            if fmi == 2:
                expected = [str(i + 1) for i, (v, _) in enumerate(variables)
                            if v["causality"] == "output"]
                for name in ("Outputs", "InitialUnknowns"):
                    self.assertEqual(
                        [e.get("index")
                         for e in root.find(f"ModelStructure/{name}")], expected)
            else:
                for name in ("Output", "InitialUnknown"):
                    self.assertEqual(
                        [e.get("valueReference")
                         for e in root.iter(name)],
                        [v["valueReference"] for v in outputs])

    def test_units_are_products_of_base_units(self):
        units = {unit.get("name"): unit
                 for unit in self.made(3, LIFELIKE).iter("Unit")}
        base = units["degree/s"].find("BaseUnit").attrib
        self.assertEqual(base.keys(), {"s", "rad", "factor"})
        self.assertAlmostEqual(float(base["factor"]), 0.017453292519943295)
        self.assertEqual(units["W/(m K)"].find("BaseUnit").attrib,
                         {"kg": "1", "m": "1", "s": "-3", "K": "-1"})
        self.assertEqual(units["degC"].find("BaseUnit").attrib,
                         {"K": "1", "offset": "273.15"})
        self.assertIsNone(units["degree/sqrt(s)"].find("BaseUnit"))

    def test_the_binary_runs_from_the_archive(self):
        root = self.made(3)
        references = {v["name"]: int(v["valueReference"])
                      for v, _ in self.variables(root)}
        binary = ctypes.CDLL(str(self.dir / "gyro/binaries/x86_64-linux"
                                 / "beamgyro_fmu.so"))
        make = binary.fmi3InstantiateCoSimulation
        make.restype = ctypes.c_void_p
        said = []
        logger = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_int,
                                  ctypes.c_char_p, ctypes.c_char_p)(
            lambda _, status, category, message: said.append(message))
        resources = str(self.dir / "gyro/resources").encode() + b"/"
        gyro = ctypes.c_void_p(make(
            b"gyro", root.get("instantiationToken").encode(), resources,
            False, False, False, False, None, ctypes.c_size_t(0), None, logger,
            None))
        self.assertEqual(said, [])
        number, one = ctypes.c_double, ctypes.c_size_t(1)

        def reference(name):
            return ctypes.byref(ctypes.c_uint32(references[name]))

        rate = number(20)
        self.assertEqual(binary.fmi3SetFloat64(
            gyro, reference("true_rate"), one, ctypes.byref(rate), one), 0)
        self.assertEqual(binary.fmi3EnterInitializationMode(
            gyro, False, number(0), number(0), False, number(0)), 0)
        self.assertEqual(binary.fmi3ExitInitializationMode(gyro), 0)
        flags = [ctypes.byref(ctypes.c_bool(True)) for _ in range(3)]
        last, shown = number(), number()
        self.assertEqual(binary.fmi3DoStep(
            gyro, number(0), number(0.1), True, *flags, ctypes.byref(last)), 0)
        self.assertEqual(binary.fmi3GetFloat64(
            gyro, reference("rate"), one, ctypes.byref(shown), one), 0)
        self.assertEqual(last.value, 0.1)
        self.assertAlmostEqual(shown.value, 20.5, delta=0.5)
        binary.fmi3FreeInstance(gyro)

    @unittest.skipUnless(importlib.util.find_spec("fmpy"),
                         "FMPy is not installed")
    def test_fmpy_validates_and_simulates(self):
        import fmpy
        import fmpy.validation
        for fmi in (2, 3):
            self.made(fmi)
            path = str(self.dir / "gyro.fmu")
            self.assertEqual(fmpy.validation.validate_fmu(path), [])
            result = fmpy.simulate_fmu(path, stop_time=1, output_interval=0.1)
            self.assertEqual(len(result), 11)

    def test_what_is_wrong_is_said(self):
        for words, says in [
                (["-o", "gyro.zip"], ["gyro.zip", ".fmu"]),
                (["-o", "gyro.fmu", "--fmi", "1"], ["--fmi 1", "2", "3"]),
                (["-o", "gyro.fmu", "--fidelity", "carrier"],
                 ["--fidelity carrier", "quasistatic", "envelope"]),
                (["-o", "gyro.fmu", "--set", "beam.length=1"],
                 ["--set beam.length=1", "length_m"]),
                (["-o", "gyro.fmu", "--set", "beam.length_m=40"],
                 ["beam.length_m: 40 is out of range"])]:
            self.rejected("fmu", NOMINAL, *words, says=says)
        self.rejected("fmu", LIFELIKE, "--fidelity", "envelope", "-o",
                      "gyro.fmu", says=[LIFELIKE.name, "envelope"])

    def test_the_fidelity_is_in_the_archive(self):
        root = self.made(2, NOMINAL, "--fidelity", "envelope")
        self.assertIn("envelope", root.get("description"))
        self.assertEqual((self.dir / "gyro/resources/fidelity.txt").read_text(),
                         "envelope")
