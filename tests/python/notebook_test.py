# SPDX-License-Identifier: MIT
"""What a notebook shows: pictures, tables of a validation, progress."""

import io
import re
import sys

import pytest
from matplotlib import image, pyplot

import beamgyro as bg
from beamgyro import _progress

from program import SCENARIOS

PNG = b"\x89PNG\r\n\x1a\n"


def test_a_figure_shows_itself_as_a_picture(sweeps, tmp_path):
    figure = sweeps[0].beamgyro.plot()
    shown = figure._repr_png_()
    assert shown.startswith(PNG)
    pixels = image.imread(io.BytesIO(shown))
    assert pixels.shape[1] == 800
    assert len({tuple(pixel) for pixel in pixels[200]}) > 3  # curves
    bg.plots.save(figure, tmp_path / "still.png")  # has its layout


def test_a_panel_is_drawn_in_axes_of_the_user(sweeps):
    figure, (rate, temperature) = pyplot.subplots(2)
    assert sweeps[0].beamgyro.plot(ax=rate) is figure
    sweeps[0].beamgyro.plot(ax=temperature, panel="temperature")
    own = sweeps[0].beamgyro.plot()
    for axes, panel in ((rate, own.axes[0]), (temperature, own.axes[1])):
        assert [line.get_ydata().tolist() for line in axes.lines] == \
            [line.get_ydata().tolist() for line in panel.lines]
        assert axes.get_ylabel() == panel.get_ylabel()
        assert axes.get_legend() is not None
    with pytest.raises(ValueError, match="panel 'left': .* expected one of "
                       "rate, temperature"):
        sweeps[0].beamgyro.plot(ax=rate, panel="left")
    pyplot.close(figure)


def test_the_table_of_a_device_draws_itself():
    table = bg.characterise(SCENARIOS / "devices/nominal.toml",
                            slice(-40, 60, 10))
    curves = curves_of(bg.plots.plot_table(table))
    assert table.bias.values.tolist() in curves
    assert curves_of(table.beamgyro.plot()) == curves


def curves_of(figure):
    return [list(line.get_ydata()) for axes in figure.axes
            for line in axes.lines]


def words_of(page):
    return re.sub("<[^>]+>", "|", page)


def test_a_failed_validation_says_what_failed_and_what_was_not_tested():
    run = bg.run(SCENARIOS / "rate_table.toml", set={"duration_s": 3300})
    result = bg.validate(lambda signals: 0.5 * signals.rate.values, run)
    page = result._repr_html_()
    assert "FAIL" in page and result.data["words"].split(".")[0] in page
    checks = words_of(page.split("<b>Checks</b>")[1])
    outcomes = re.findall(r"\|(fail|not tested|pass)\|", checks)
    expected = {True: "pass", False: "fail", None: "not tested"}
    assert sorted(outcomes[:len(result.checks)]) == sorted(
        expected[one["passed"]] for one in result.checks.values())
    # The worst stand at the top.
    assert outcomes == sorted(outcomes, key=["fail", "not tested",
                                             "pass"].index)
    assert {"fail", "not tested", "pass"} <= set(outcomes)
    for name, one in result.checks.items():
        assert f"|{name}|" in checks and one["words"][:40] in checks


def test_limits_undecided_ones_and_warnings_are_shown(sweeps):
    spec = {"name": "mine", "limits": {
        "residual_rms_deg_per_s": {"max": 1e-6, "source": "none"},
        "scale_factor_error_ppm": {"max": 1e4, "source": "none"}}}
    cubic = bg.train(SCENARIOS / "models/cubic.toml", sweeps[0])
    result = bg.validate(cubic, sweeps[1], spec=spec)
    page = words_of(result._repr_html_())
    limits = page.split("|Limits|")[1].split("|Checks|")[0]
    assert "at most 1e-06" in limits and "at most 1e+04" in limits
    assert re.search(r"\|fail\|+residual_rms_deg_per_s\|", limits)
    assert re.search(r"\|undecided\|+scale_factor_error_ppm\|", limits)
    assert "compared with" in limits
    result.data["warnings"].append("a <word>")
    assert "a &lt;word&gt;" in result._repr_html_()


def test_objects_show_what_they_are():
    device = bg.Device(SCENARIOS / "devices/nominal.toml",
                       set={"beam.length_m": 0.0401})
    scenario = bg.Scenario(SCENARIOS / "ten_minutes.toml", device=device)
    campaign = bg.Campaign(SCENARIOS / "campaigns/small.toml", devices=7)
    cubic = bg.train(SCENARIOS / "models/cubic.toml", bg.run(
        SCENARIOS / "ramp.toml", set={"output_rate_Hz": 1}))
    assert re.search(r"\|beam.length_m=0.0401\|.*\|drive frequency at 25 degC\|"
                     r"+[\d.]+ Hz\|", words_of(device._repr_html_()))
    assert "|600 s, 3000 samples at 5 Hz|" in words_of(scenario._repr_html_())
    assert re.search(r"\|devices\|+7\|", words_of(campaign._repr_html_()))
    shown = words_of(cubic._repr_html_())
    assert f"|{cubic.method}|" in shown and "|rate, temperature|" in shown
    own = bg.Compensator(lambda signals: signals.rate.values, name="a <b>")
    assert "a &lt;b&gt;" in own._repr_html_()


def test_progress_in_a_notebook_is_a_bar_of_tqdm(monkeypatch, capsys):
    pytest.importorskip("tqdm")
    # Another test may have imported it.
    monkeypatch.delitem(sys.modules, "ipykernel", raising=False)
    assert _progress.notebook_tqdm() is None
    monkeypatch.setitem(sys.modules, "ipykernel", sys)
    monkeypatch.setattr(_progress, "_DELAY_S", 0)
    with _progress.watched(True, "simulating") as tell:
        assert isinstance(tell, _progress.NotebookBar)
        tell(0.25)
        tell(0.5)
        assert tell._bar.n == 50
        tell(1)
    printed = capsys.readouterr().err
    assert "simulating" in printed and "25 %" in printed
    monkeypatch.setitem(sys.modules, "tqdm.std", None)
    monkeypatch.setitem(sys.modules, "tqdm.notebook", None)
    with _progress.watched(True, "simulating") as tell:
        assert isinstance(tell, _progress.Bar)
