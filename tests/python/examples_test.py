# SPDX-License-Identifier: MIT
"""The examples run, and their types and those of the package hold."""

import ast
import inspect
import os
import pathlib
import sys

import pytest

from program import PATIENCE, ROOT, SCENARIOS, said

EXAMPLES = ROOT / "examples/python"
PACKAGE = ROOT / "python"


def run(folder, *arguments, **variables):
    return said(sys.executable, *arguments, cwd=folder,
                env={**os.environ, **variables})


def test_drift_curve(tmp_path):
    script = EXAMPLES / "drift_curve.py"
    lines = run(tmp_path, script, SCENARIOS / "devices/nominal.toml",
                "curve.png").splitlines()
    assert (tmp_path / "curve.png").stat().st_size > 10000
    assert len(lines) == 12
    assert lines[1].split()[0] == "-40"
    code = [line for line in script.read_text().splitlines()
            if line and not line.startswith(("#", '"""'))]
    assert len(code) <= 10


def test_sklearn_compensator(tmp_path):
    pytest.importorskip("sklearn")
    printed = run(tmp_path, EXAMPLES / "sklearn_compensator.py",
                  SCENARIOS / "soak_sweep_train.toml",
                  SCENARIOS / "soak_sweep_test.toml")
    words = printed.splitlines()[0].split()
    before, after = float(words[1]), float(words[4])
    assert after < before / 2  # the tenfold is usual


def test_torch_network(tmp_path):
    pytest.importorskip("torch")
    # Zeros that differ between units cannot be learned from other units.
    campaign = tmp_path / "zero_set.toml"
    campaign.write_text("".join(
        line.replace("../", f"{SCENARIOS}/") for line in
        (SCENARIOS / "campaigns/small.toml").read_text().splitlines(True)
        if not line.startswith('"readout.offset_trim_deg_per_s"')))
    printed = run(tmp_path, EXAMPLES / "torch_network.py", campaign,
                  tmp_path / "set")
    words = printed.splitlines()[0].split()
    before, after = float(words[3]), float(words[6])
    assert after < before
    assert "test devices:" in printed


@pytest.mark.parametrize("name", [
    path.stem for path in sorted(EXAMPLES.glob("*.ipynb"))])
def test_notebook_in_a_kernel(tmp_path, name):
    """Its cells run in order in a kernel, as in Jupyter."""
    for module in ("nbformat", "nbclient", "ipykernel", "matplotlib"):
        pytest.importorskip(module)
    import nbclient
    import nbformat
    notebook = nbformat.read(EXAMPLES / f"{name}.ipynb", 4)
    (tmp_path / "scenarios").symlink_to(SCENARIOS)
    nbclient.NotebookClient(
        notebook, timeout=PATIENCE, kernel_name="python3",
        resources={"metadata": {"path": str(tmp_path)}}).execute()
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in cells] == list(
        range(1, len(cells) + 1))
    shown = [output.data for cell in cells for output in cell.outputs
             if output.output_type in ("execute_result", "display_data")]
    assert any("<b>Checks</b>" in data.get("text/html", "") for data in shown)
    # A recording draws itself, without pyplot and without its magic.
    assert any(data.get("image/png") for data in shown)


# A misspelt name or type, and what mypy must say of it.
MISSPELT = {"bg.trian('m.toml', 'run.h5')": 'has no attribute "trian"',
            "bg.plots.plto('run.h5')": 'has no attribute "plto"',
            "x: int = bg.run('s.toml')": "Incompatible types",
            "from beamgyro import opne_set": 'has no attribute "opne_set"',
            "bg.plots.plot('run.h5')": None}


def checked(tool, folder, *arguments):
    """What mypy or stubtest prints, with the stub of the compiled part."""
    for module in ("mypy", "xarray", "matplotlib", "h5py"):
        pytest.importorskip(module)
    (folder / "mypy.ini").write_text(
        "[mypy]\n[mypy-matplotlib.*,h5py.*]\nignore_missing_imports = True\n")
    return said(sys.executable, "-m", tool, *arguments, cwd=folder,
                allowed=(0, 1), env={**os.environ, "MYPYPATH": str(PACKAGE)})


@pytest.mark.early
def test_types_of_the_examples(tmp_path):
    """mypy --strict, and what the stub says of the compiled part."""
    (tmp_path / "misspelt.py").write_text(
        "\n".join(["import beamgyro as bg", *MISSPELT]) + "\n")
    found = [line for line in checked(
        "mypy", tmp_path, "--strict", "--config-file", "mypy.ini",
        "--cache-dir", "cache", "misspelt.py", *sorted(
            script for script in EXAMPLES.glob("*.py")
            if script.stem != "torch_network")).splitlines()
        if ": error: " in line]
    expected = list(filter(None, MISSPELT.values()))
    assert len(found) == len(expected), found
    for line, words in zip(found, expected):
        assert line.startswith("misspelt.py:") and words in line


@pytest.mark.deep  # mypy reads torch for a minute; the example runs in test.sh
def test_types_of_the_network(tmp_path):
    pytest.importorskip("torch")
    assert "Success" in checked(
        "mypy", tmp_path, "--strict", "--config-file", "mypy.ini",
        "--cache-dir", "cache", EXAMPLES / "torch_network.py")


# What stubtest says of the package that is no fault of it.
ALLOWED = """
# Classes of pybind11 have a metaclass and a general __init__ of its own.
beamgyro\\._core\\.[A-Z]\\w+(\\.__init__)?
# Names of Python's own library, which modules import: the stubs of mypy's
# typeshed differ from Python itself.
beamgyro\\.([a-z_0-9]+\\.)*(Callable|Generic|Iterable|Iterator|Mapping|ModuleType|NamedTuple|Sequence|Sized|TypeGuard|field)(\\.\\w+)?
# An alias of a Literal, which stubtest takes for a Union.
beamgyro\\._(many|scenario)\\.Fidelity
# Of packages without types, imported for annotations alone; what matplotlib
# adds to every class of artists.
beamgyro\\._\\w+\\.(Axes|Figure|Gyro|pd)
beamgyro\\.plots\\.style\\.Picture\\.set
# Properties of the compiled part (Final in the stub) and of the class Native,
# which cannot be set, as mypy knows.
beamgyro\\._core\\.[A-Z]\\w+\\.(curve|device|duration|files|highest_temperature|lowest_temperature|method|output_rate|profiles|warnings)
beamgyro\\.(_\\w+\\.)?[A-Z]\\w+\\.(devices|directory|duration_s|failures|fidelity|inputs|name|output_rate_Hz|overrides|runs|samples|seed|text|title)
# Their keywords come from lists; tests look at them.
beamgyro\\.(_validation\\.)?validate
beamgyro\\.(_design\\.)?design_device
"""


def declared(body):
    """Names of the stub's definitions and the bodies of its classes."""
    names = {}
    for node in body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            names[node.name] = getattr(node, "body", [])
        elif isinstance(node, ast.AnnAssign):
            names[node.target.id] = []
        elif isinstance(node, ast.Assign):
            names |= {target.id: [] for target in node.targets}
    return names


def public(names):
    return {name for name in names if not name.startswith("_")}


def test_the_stub_of_the_compiled_part_has_its_names():
    from beamgyro import _core
    stub = declared(ast.parse(
        (PACKAGE / "beamgyro/_core.pyi").read_text()).body)
    assert public(vars(_core)) == public(stub)
    for name in public(stub):
        thing = getattr(_core, name)
        if isinstance(thing, type):
            assert public(vars(thing)) == public(declared(stub[name])), name


# What stands for it in test.sh: the test above compares the names of the
# compiled part, and mypy reads stub and package for the examples. Arguments,
# their defaults and types are compared with what is imported only here.
@pytest.mark.deep
def test_stubs_are_those_of_the_package(tmp_path):
    (tmp_path / "allowed").write_text(ALLOWED)
    assert "Success" in checked("mypy.stubtest", tmp_path, "beamgyro",
                                "--allowlist", "allowed",
                                "--mypy-config-file", "mypy.ini")


def test_validate_shows_the_options_of_the_compiled_part():
    import beamgyro as bg
    from beamgyro import _core
    shown = inspect.signature(bg.validate).parameters
    rows = [row[0] for row in _core.validation_members()]
    assert "full_scale" in rows and "spec" in rows
    assert list(shown)[-len(rows):] == rows
    assert "options" not in shown
    for row in rows:
        assert f"\n        {row}: " in bg.validate.__doc__, row
    with pytest.raises(TypeError, match="full_scal"):
        bg.validate("cubic.json", "test.h5", full_scal=300)


def test_every_public_object_has_a_docstring():
    import beamgyro as bg
    assert bg.__doc__
    for name in bg.__all__:
        thing = getattr(bg, name)
        if name == "__version__":
            continue
        assert thing.__doc__, name
        if isinstance(thing, type):
            for member, value in vars(thing).items():
                if not member.startswith("_") and (
                        callable(value) or isinstance(
                            value, (property, classmethod))):
                    assert value.__doc__, f"{name}.{member}"
    assert (pathlib.Path(bg.__file__).parent / "py.typed").exists()
