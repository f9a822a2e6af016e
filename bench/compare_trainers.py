#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Our Levenberg-Marquardt trainer against those of other libraries.

compare_trainers.py BUILD_DIR [--seeds N] [--json FILE]: takes data and start
weights from BUILD_DIR/bench/beamgyro_trainer, trains with every library found,
one after the other on one thread, and asks our trainer for its processor time
to the residual each of them ends with. Prints both; FILE gets every number.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import time
import warnings

for name in ("OMP", "OPENBLAS", "MKL", "BLIS"):
    os.environ[name + "_NUM_THREADS"] = "1"  # before numpy is loaded

import numpy as np

# Epochs of the trainers that have no stop of their own within reach, and of
# ours; repetitions of a training, of which the fastest counts.
CASES = {
    "soak": {"title": "1-6-1, 37 points without noise", "ours": 2000,
             "scipy": 1900, "lbfgs": 2000, "fann": 5000, "opencv": 5000,
             "repeat": 3},
    "noisy": {"title": "1-6-1, 37 points with noise", "ours": 2000,
              "scipy": 1900, "lbfgs": 2000, "fann": 5000, "opencv": 5000,
              "repeat": 3},
    "rows": {"title": "3-14-1, 20,000 rows", "ours": 300, "scipy": 100,
             "lbfgs": 500, "fann": 500, "opencv": 100, "repeat": 1},
}


class Reached(Exception):
    pass


class Network:
    """tanh hidden layer, linear output; weights in the order of ours."""

    def __init__(self, data):
        self.x = np.ascontiguousarray(np.array(data["inputs"]).T)
        self.target = np.array(data["target"])
        self.inputs, self.hidden, _ = data["layer_sizes"]
        self.at = None
        self.goal = 0  # rms that ends forward(), and so the training

    def parts(self, w):
        k = self.inputs * self.hidden
        return (w[:k].reshape(self.inputs, self.hidden), w[k:k + self.hidden],
                w[k + self.hidden:k + 2 * self.hidden], w[-1])

    def forward(self, w):  # residual and Jacobian are asked for at the same w
        if self.at is None or not np.array_equal(self.at, w):
            self.at = w.copy()
            W, b, v, c = self.parts(w)
            self.a = np.tanh(self.x @ W + b)
            self.error = self.a @ v + c - self.target
            if self.error @ self.error <= self.goal ** 2 * len(self.error):
                raise Reached
        return self.error

    def jacobian(self, w):
        self.forward(w)
        k, h = self.inputs * self.hidden, self.hidden
        J = np.empty((len(self.target), len(w)))
        D = J[:, k:k + h]
        np.multiply(1 - self.a ** 2, w[k + h:k + 2 * h], out=D)
        for i in range(self.inputs):
            np.multiply(D, self.x[:, i:i + 1], out=J[:, i * h:(i + 1) * h])
        J[:, k + h:k + 2 * h] = self.a
        J[:, -1] = 1
        return J

    def rms(self, w):
        self.at = None
        return float(np.sqrt(np.mean(self.forward(np.array(w)) ** 2)))


def scipy_lm(network, start, case):
    from scipy.optimize import least_squares

    def train():
        network.at = None
        return least_squares(network.forward, start, network.jacobian,
                             method="lm", max_nfev=case["scipy"]).x
    return train


def torch_lbfgs(network, start, case):
    import torch
    torch.set_num_threads(1)
    x = torch.from_numpy(network.x)
    target = torch.from_numpy(network.target)

    def train():
        weights = [torch.tensor(np.array(part), requires_grad=True)
                   for part in network.parts(start)]
        W, b, v, c = weights
        optimiser = torch.optim.LBFGS(
            weights, max_iter=case["lbfgs"], max_eval=10 * case["lbfgs"],
            tolerance_grad=1e-10, tolerance_change=1e-12, history_size=50,
            line_search_fn="strong_wolfe")

        def loss():
            optimiser.zero_grad()
            F = ((torch.tanh(x @ W + b) @ v + c - target) ** 2).mean() / 2
            F.backward()
            return F
        optimiser.step(loss)
        return np.concatenate([p.detach().numpy().ravel() for p in weights])
    return train


def sklearn_lbfgs(network, start, case):
    from sklearn.neural_network import MLPRegressor
    model = MLPRegressor((network.hidden,), "tanh", solver="lbfgs", alpha=0,
                         tol=1e-10, max_iter=1, max_fun=10 ** 6,
                         warm_start=True)
    model.fit(network.x, network.target)  # gives it weights to replace
    model.max_iter = case["lbfgs"]

    def train():
        W, b, v, c = network.parts(start)
        model.coefs_ = [W.copy(), v[:, None].copy()]
        model.intercepts_ = [b.copy(), np.array([c])]
        model.fit(network.x, network.target)
        return np.concatenate([model.coefs_[0].ravel(), model.intercepts_[0],
                               model.coefs_[1].ravel(), model.intercepts_[1]])
    return train


PYTHON = {"SciPy least_squares lm": ("scipy", scipy_lm),
          "PyTorch LBFGS strong_wolfe": ("torch", torch_lbfgs),
          "scikit-learn MLPRegressor lbfgs": ("sklearn", sklearn_lbfgs)}
PROGRAMS = {"FANN RPROP": ("fann", "beamgyro_fann", []),
            "OpenCV ANN_MLP RPROP": ("opencv", "beamgyro_opencv", ["rprop"]),
            "OpenCV ANN_MLP BACKPROP":
                ("opencv", "beamgyro_opencv", ["backprop"])}


def in_python(trainer, data, case):
    network, results = Network(data), []
    for start in map(np.array, data["weights"]):
        train = trainer(network, start, case)
        took = []
        for _ in range(case["repeat"]):
            begin = time.process_time()
            w = train()
            took.append(time.process_time() - begin)
        results.append({"rms": network.rms(w), "seconds": min(took)})
    return results


def scipy_time_to(data, seed, goal, case):
    network = Network(data)
    network.goal = goal
    begin = time.process_time()
    try:
        scipy_lm(network, np.array(data["weights"][seed]), case)()
    except Reached:
        return time.process_time() - begin
    return None


def others(bench, data, text, case):
    """Name of a trainer and its results, one per start."""
    for name, (module, trainer) in PYTHON.items():
        try:
            __import__(module)
        except ImportError:
            print(f"{name}: python3-{module} is not installed, left out")
            continue
        yield name, in_python(trainer, data, case)
    for name, (key, program, words) in PROGRAMS.items():
        if not (bench / program).exists():
            print(f"{name}: {program} was not built, left out")
            continue
        yield name, json.loads(subprocess.run(
            [bench / program, *words, str(case[key])], input=text,
            check=True, capture_output=True, text=True).stdout)


def ours(bench, name, seed, threads, epochs, goals):
    return json.loads(subprocess.run(
        [bench / "beamgyro_trainer", name, str(seed), str(threads),
         str(epochs), *map(repr, goals)],
        check=True, capture_output=True, text=True).stdout)


def compare(bench, name, seeds):
    case = CASES[name]
    text = subprocess.run([bench / "beamgyro_trainer", name, str(seeds)],
                          check=True, capture_output=True, text=True).stdout
    data = json.loads(text)
    end = [ours(bench, name, seed, 1, case["ours"], [0.0])[0]
           for seed in range(seeds)]
    two = [ours(bench, name, seed, 2, case["ours"], [0.0])[0]
           for seed in range(seeds)]
    print(f"\n{case['title']}, {seeds} starts")
    print(f"ours: rms median {median(end, 'rms'):.4g}, worst "
          f"{max(r['rms'] for r in end):.4g}; {median(end, 'seconds'):.3g} s, "
          f"{median(end, 'epochs'):.0f} epochs; wall time on two threads "
          f"{median(two, 'seconds'):.3g} s")
    result = {"ours": end, "ours_two_threads": two, "others": {}}
    for trainer, theirs in others(bench, data, text, case):
        # Equal to 1 part in 1e4: where both end in one minimum, rounding
        # decides which is lower.
        goals = [1.0001 * t["rms"] for t in theirs]
        to_goal = [ours(bench, name, seed, 1, case["ours"], [goal])[0]
                   for seed, goal in enumerate(goals)]
        for seed, (mine, goal) in enumerate(zip(to_goal, goals)):
            mine["reached"] = mine["rms"] <= goal
            mine["theirs"] = theirs[seed]["seconds"]
            if not mine["reached"] and trainer.startswith("SciPy"):
                # Theirs is lower: the time of both to where ours ends.
                mine["theirs"] = scipy_time_to(
                    data, seed, 1.0001 * mine["rms"], case)
        result["others"][trainer] = {"theirs": theirs, "to_goal": to_goal}
        report(trainer, end, theirs, to_goal)
    return result


def median(results, key):
    return statistics.median(r[key] for r in results)


def report(trainer, end, theirs, to_goal):
    reached = [mine for mine in to_goal if mine["reached"]]
    short = [mine for mine in to_goal
             if not mine["reached"] and trainer.startswith("SciPy")
             and mine["theirs"]]
    excess = sorted(mine["rms"] / other["rms"]
                    for mine, other in zip(end, theirs))
    line = (f"{trainer}: rms median {median(theirs, 'rms'):.4g}, "
            f"{median(theirs, 'seconds'):.3g} s; our final rms over theirs: "
            f"median {statistics.median(excess):.3g}, worst {excess[-1]:.3g}; ")
    for where, met in (("to their residual", reached),
                       ("to ours where theirs is lower", short)):
        if met:
            a, b = median(met, "theirs"), median(met, "seconds")
            line += (f"{where} ({len(met)} of {len(theirs)} starts) {a:.3g} s "
                     f"and {b:.3g} s, ratio {a / b:.3g}; ")
    print(line.rstrip("; "), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--case", choices=CASES, action="append")
    parser.add_argument("--json", type=pathlib.Path)
    options = parser.parse_args()
    warnings.filterwarnings("ignore", "(?s).*lbfgs failed to converge")
    results = {name: compare(options.build / "bench", name, options.seeds)
               for name in options.case or CASES}
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    sys.exit(main())
