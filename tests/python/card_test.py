# SPDX-License-Identifier: MIT
"""Cards of sets: the Croissant file and the page beside it."""

import hashlib
import json
import re
import warnings

import pytest

import beamgyro as bg
from program import PROGRAM, SCENARIOS, said

SMALL = SCENARIOS / "campaigns/small.toml"
STATED = ("--license", "CC-BY-4.0", "--url", "https://example.org/set",
          "--creator", "A laboratory", "--date", "2026-11-28")
CR = "http://mlcommons.org/croissant/"


@pytest.fixture(scope="module", name="folder")
def make_set(tmp_path_factory):
    folder = tmp_path_factory.mktemp("card") / "made"
    said(PROGRAM, "generate", SMALL, "-o", folder, "--devices", 7)
    said(PROGRAM, "card", folder, *STATED)
    return folder


@pytest.fixture(scope="module", name="card")
def read_card(folder):
    return json.loads((folder / "croissant.json").read_text())


def objects(part):
    """Every object of a JSON text, but those of inline data."""
    if isinstance(part, dict):
        yield part
        for key, value in part.items():
            if key not in ("data", "@context"):
                yield from objects(value)
    elif isinstance(part, list):
        for value in part:
            yield from objects(value)


def test_it_has_what_croissant_requires(card):
    for key in ("@context", "@type", "conformsTo", "name", "description",
                "license", "url", "creator", "datePublished", "distribution"):
        assert card[key], key
    assert card["@type"] == "sc:Dataset"
    assert card["conformsTo"] == f"{CR}1.0"
    assert re.fullmatch(r"\d+\.\d+\.\d+", card["version"])
    assert card["license"] == "CC-BY-4.0"
    assert "beamgyro 0.1.0" in card["description"]


def test_every_file_is_listed_with_size_and_checksum(card, folder):
    listed = {one["@id"]: one for one in card["distribution"]}
    there = {str(path.relative_to(folder)) for path in folder.rglob("*")
             if path.is_file()}
    assert {*listed} == there - {"croissant.json"}
    for name, one in listed.items():
        content = (folder / name).read_bytes()
        assert one["@type"] == "cr:FileObject"
        assert one["contentUrl"] == one["name"] == name
        assert one["contentSize"] == f"{len(content)} B"
        assert one["sha256"] == hashlib.sha256(content).hexdigest()
        assert one["encodingFormat"] and one["description"]


def test_identifiers_are_unique_and_references_resolve(card):
    defined = [one["@id"] for one in objects(card)
               if "@id" in one and len(one) > 1]
    assert len(defined) == len({*defined})
    references = [one["@id"] for one in objects(card) if [*one] == ["@id"]]
    assert references and {*references} <= {*defined}


def test_no_table_reads_hdf5_and_its_lines_have_its_fields(card):
    tables = {one["@id"]: one for one in card["recordSet"]}
    assert {*tables} == {"splits", "devices", "variables"}
    for table in tables.values():
        fields = [one["@id"] for one in table["field"]]
        assert all("source" not in one for one in table["field"])
        assert fields == [one["name"] for one in table["field"]]
        assert all([*line] == fields for line in table["data"])
    assert tables["splits"]["dataType"] == "cr:Split"


def test_devices_have_their_split_and_numbers(card, folder):
    table, = (one for one in card["recordSet"] if one["@id"] == "devices")
    made = bg.open_set(folder)
    drawn = made.parameters()
    assert len(table["data"]) == 7
    for device, line in enumerate(table["data"]):
        assert line["devices/device"] == device
        assert line["devices/split"] == made.part(device)
        for name in drawn.data_vars:
            assert line[f"devices/{name}"] == float(drawn[name][device])
    offset, = (one for one in table["field"]
               if one["@id"] == "devices/patches_offset_m_0")
    assert offset["description"].endswith("[m]")


def test_variables_have_units_and_roles(card, folder):
    table, = (one for one in card["recordSet"] if one["@id"] == "variables")
    lines = {line["variables/variable"]: line for line in table["data"]}
    run = bg.open_set(folder)["warm_up", 0]
    for name in run.data_vars:
        if name == "status":
            continue
        line = lines[f"warm_up/{name}"]
        assert line["variables/units"] == run[name].attrs["units"]
        assert line["variables/role"] == run[name].attrs["role"]
    assert lines["warm_up/true_bias"]["variables/rate"] == 1.0
    assert lines["warm_up/rate"]["variables/rate"] == pytest.approx(5.0)


def test_its_context_gives_every_term_a_meaning(folder):
    rdflib = pytest.importorskip("rdflib")
    graph = rdflib.Graph().parse(folder / "croissant.json", format="json-ld",
                                 publicID="https://example.org/set/")
    known = (CR, "https://schema.org/", "http://purl.org/dc/terms/",
             str(rdflib.RDF))
    assert all(str(predicate).startswith(known)
               for _, predicate, _ in graph)
    term = rdflib.URIRef
    dataset, = graph.subjects(rdflib.RDF.type,
                              term("https://schema.org/Dataset"))
    assert str(graph.value(dataset, term(
        "http://purl.org/dc/terms/conformsTo"))) == f"{CR}1.0"
    files = {*graph.subjects(rdflib.RDF.type, term(f"{CR}FileObject"))}
    tables = {*graph.subjects(rdflib.RDF.type, term(f"{CR}RecordSet"))}
    assert files == {*graph.objects(dataset,
                                    term("https://schema.org/distribution"))}
    assert tables == {*graph.objects(dataset, term(f"{CR}recordSet"))}
    assert all(graph.value(table, term(f"{CR}data")) for table in tables)
    assert all(graph.value(file, term("https://schema.org/sha256"))
               for file in files)


def test_the_page_says_what_the_set_cannot_teach(folder):
    text = (folder / "README.md").read_text()
    assert "Licence: CC-BY-4.0" in text
    cannot = text.partition("## What it cannot teach")[2].partition("\n## ")[0]
    assert "no sample was measured" in cannot
    assert "every run is at rest" in cannot
    assert "one run" in cannot
    assert "| warm_up | true_rate | degree/s | truth |" in text


def test_a_set_with_a_card_is_whole_and_goes_on(folder):
    assert "whole" in said(PROGRAM, "verify", folder)
    said(PROGRAM, "generate", SMALL, "-o", folder, "--devices", 7, "--resume")
    before = (folder / "croissant.json").read_bytes()
    said(PROGRAM, "card", folder, *STATED)
    assert (folder / "croissant.json").read_bytes() == before


def test_what_is_missing_is_a_warning(folder, tmp_path):
    made = bg.generate(SMALL, tmp_path / "set", devices=2, progress=False)
    with pytest.warns(bg.BeamgyroWarning,
                      match="no license, url, creator, datePublished, which"):
        made.card()
    assert "license" not in json.loads(
        (tmp_path / "set/croissant.json").read_text())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        made.card(license="MIT", url="https://x.org", creator="x",
                  date="2026-01-02")


@pytest.mark.parametrize("options, words", [
    ({"url": "x.org"}, "url=x.org: expected an address"),
    ({"date": "28.11.2026"}, "date=28.11.2026: expected a date"),
    ({"date": "2026-13-01"}, "date=2026-13-01: expected a date"),
    ({"version": "1.0"}, "version=1.0: expected three numbers"),
    ({"license": "a\nb"}, "license: expected a text"),
])
def test_what_is_wrong_is_said(folder, options, words):
    with pytest.raises(ValueError, match=words):
        bg.open_set(folder).card(**options)


def test_a_page_of_the_user_and_a_damaged_set_are_refused(tmp_path):
    made = bg.generate(SMALL, tmp_path / "set", devices=2, progress=False)
    page = tmp_path / "set/README.md"
    page.write_text("mine")
    with pytest.raises(ValueError, match="README.md: is there already"):
        made.card()
    assert page.read_text() == "mine"
    page.unlink()
    source, = (tmp_path / "set/source").glob("*.toml")
    source.write_text("name = 1")
    with pytest.raises(ValueError, match="expected a whole set"):
        made.card()
