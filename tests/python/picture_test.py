# SPDX-License-Identifier: MIT
"""Datasets of the package are drawn as the command draws files."""

import beamgyro as bg


def curves(figure):
    return [line.get_ydata().tolist() for axes in figure.axes
            for line in axes.lines]


def test_a_dataset_draws_itself_as_its_file_is_drawn(sweeps, tmp_path):
    sweeps[0].beamgyro.save(tmp_path / "sweep.h5")
    figure = sweeps[0].beamgyro.plot()
    assert figure.axes[0].get_ylabel() == "rate at rest [°/s]"
    assert curves(figure) == curves(bg.plots.plot(tmp_path / "sweep.h5"))


def test_several_datasets_over_each_other(sweeps):
    figure = bg.plots.plot_recording(*sweeps, names=["a", "b", "c"])
    assert [line.get_label() for line in figure.axes[0].lines] == list("abc")
