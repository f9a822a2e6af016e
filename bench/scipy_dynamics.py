#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Our envelope and carrier against SciPy's solvers on the same equations.

scipy_dynamics.py BUILD_DIR: runs BUILD_DIR/beamgyro for a recording, reads the
parameters of its device and our timings from BUILD_DIR/bench/beamgyro_model,
integrates the same right-hand sides, and prints evaluations, times and errors
(largest difference of the output from ours at a tight tolerance) and the ratio
of the best time SciPy needs for our error to the time we took.
"""

import cmath
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import time
import warnings

import numpy as np
from scipy.integrate import solve_ivp

ROOT = pathlib.Path(__file__).resolve().parent.parent
T0 = 298.15
DEGREE = math.pi / 180
NODES = 20  # place of the first node temperature in the envelope's state


class Envelope:
    """(2.13) with the loops and the thermal network, open loop."""

    def __init__(self, p, rate):
        self.p, self.l, self.t, self.rate = p, p["loops"], p["thermal"], rate
        grid = np.array(p["modal"])
        self.first, self.step = p["first_K"], p["step_K"]
        # Cubic Hermite over the grid, powers of the place within a cell.
        slope = np.gradient(grid, axis=0, edge_order=2)
        slope[2:-2] = (8 * (grid[3:-1] - grid[1:-3])
                       - (grid[4:] - grid[:-4])) / 12
        a, b, da, db = grid[:-1], grid[1:], slope[:-1], slope[1:]
        self.cells = [tuple(map(np.array, cell)) for cell in zip(
            a, da, 3 * (b - a) - 2 * da - db, 2 * (a - b) + da + db)]
        self.exchange = np.array(self.t["exchange"]).T
        self.powered = np.array(self.t["powered"])
        self.axis = complex(*self.l["charge_axis"])
        self.directions = p["directions"]
        self.evaluations = 0

    def modal(self, T):
        place = (T - self.first) / self.step
        i = int(place)
        s = place - i
        c = self.cells[i]
        return ((c[0] + s * (c[1] + s * (c[2] + s * c[3]))).tolist(),
                (c[1] + s * (2 * c[2] + 3 * s * c[3])) / self.step)

    def couplings(self, m):
        p, l = self.p, self.l
        A = p["amplitude"]
        d = self.directions
        drive = complex(m[6], m[7]) / A
        feedback = -complex(m[8], m[9]) * p["mass"] * A / l["feedback_scale"]
        readout = complex(m[10], m[11]) * p["mass"] * A
        return ((drive * d[0][0], drive * d[0][1]),
                (feedback * d[1][0], feedback * d[1][1]),
                (readout * d[2][0], readout * d[2][1]))

    def forces(self, m, z):
        g = self.p["angular_gain"]
        K = (m[0] - g * z * z, m[1], m[1], m[2] - g * z * z)
        V = (m[3], m[4] - 2 * g * z, m[4] + 2 * g * z, m[5])
        return K, V

    def loops(self, y):
        l = self.l
        i1, q1, i2, q2, xi, eta = y[4:10]
        a = math.hypot(i2, q2)
        s = min(max((a - 0.005) / 0.015, 0.0), 1.0)
        gain, gain_slope = s * s * (3 - 2 * s), 6 * s * (1 - s) / 0.015
        phase = math.atan2(i2, q2) - l["phase"] if gain > 0 else 0.0
        delta = gain * phase
        w = l["w_nom"] + l["K_p"] * delta + xi
        wanted = l["V_0"] * (l["K_pA"] * (1 - a) + eta)
        V = min(max(wanted, -l["V_max"]), l["V_max"])
        limited = V != wanted
        e_rate = 0.0
        if a > 1e-12:
            e_rate = -l["w_f"] * (i2 * (i1 - i2) + q2 * (q1 - q2)) / a
        V_rate = 0.0 if limited else l["V_0"] * (
            l["K_pA"] * e_rate + l["K_iA"] * (1 - a))
        return a, gain, gain_slope, phase, delta, w, V, limited, e_rate, V_rate

    def rhs(self, t, y):
        self.evaluations += 1
        state = y
        y = y.tolist()
        l, p = self.l, self.p
        m, _ = self.modal(y[NODES])
        drive, feedback, readout = self.couplings(m)
        z = self.rate(t)
        K, V = self.forces(m, z)
        a, _, _, _, delta, w, V_D, _, _, V_rate = self.loops(y)
        iw = 1j * w
        # R = P^-1, S0
        P0, P1, P2, P3 = 2 * iw + V[0], V[1], V[2], 2 * iw + V[3]
        D = P0 * P3 - P1 * P2
        R0, R1, R2, R3 = P3 / D, -P1 / D, -P2 / D, P0 / D
        S0 = K[0] - w * w + iw * V[0]
        S1, S2 = K[1] + iw * V[1], K[2] + iw * V[2]
        S3 = K[3] - w * w + iw * V[3]
        X, Y = complex(y[0], y[1]), complex(y[2], y[3])
        f0 = drive[0] * V_D - S0 * X - S1 * Y
        f1 = drive[1] * V_D - S2 * X - S3 * Y
        v0, v1 = R0 * f0 + R1 * f1, R2 * f0 + R3 * f1
        g0 = S0 * v0 + S1 * v1 - drive[0] * V_rate
        g1 = S2 * v0 + S3 * v1 - drive[1] * V_rate
        h0, h1 = R0 * g0 + R1 * g1, R2 * g0 + R3 * g1
        dX, dY = v0 + R0 * h0 + R1 * h1, v1 + R2 * h0 + R3 * h1
        U = feedback[0] * X + feedback[1] * Y
        wf, wo = l["w_f"], l["w_o"]
        dT = y[NODES + 4] - T0
        turn = cmath.exp(1j * (p["phase_tc"] + p["phase_tc2"] * dT) * dT)
        r = ((readout[0] * X + readout[1] * Y + l["feedthrough"] * V_D)
             * turn / self.axis)
        out = np.empty(26)
        out[:NODES] = (
            dX.real, dX.imag, dY.real, dY.imag,
            wf * (U.real - y[4]), wf * (-U.imag - y[5]),
            wf * (y[4] - y[6]), wf * (y[5] - y[7]),
            l["K_i"] * delta, l["K_iA"] * (1 - a),
            wf * (r.real - y[10]), wf * (r.imag - y[11]),
            wf * (y[10] - y[12]), wf * (y[11] - y[13]),
            wo * (y[12] - y[14]), wo * (y[13] - y[15]),
            wo * (y[14] - y[16]), wo * (y[15] - y[17]), 0, 0)
        out[NODES:] = self.exchange @ (state[NODES:] - T0) + self.powered
        d, t4 = y[NODES + 3] - T0, self.t
        loss = (t4["natural"] * abs(d) ** 0.25 * d
                + t4["radiation"] * (y[NODES + 3] ** 4 - T0 ** 4)
                + t4["fixture"] * d)
        out[NODES + 3] -= loss / t4["housing_capacity"]
        return out

    def jacobian(self, t, y):
        l, p = self.l, self.p
        m, dm = self.modal(y[NODES])
        dm = dm.tolist()
        drive, feedback, readout = map(np.array, self.couplings(m))
        d_drive, d_feedback, d_readout = map(np.array, self.couplings(dm))
        K, V = (np.reshape(x, (2, 2)) for x in self.forces(m, self.rate(t)))
        dK = np.array([[dm[0], dm[1]], [dm[1], dm[2]]])
        dV = np.array([[dm[3], dm[4]], [dm[4], dm[5]]])
        (a, gain, gain_slope, phase, _, w, V_D, limited, e_rate,
         V_rate) = self.loops(y)
        one = np.eye(2)
        R = np.linalg.inv(2j * w * one + V)
        S = K - w * w * one + 1j * w * V
        D = R @ R
        B = R + D @ S @ R
        A = -B @ S

        def slopes(dP, dS):
            dR = -R @ dP @ R
            dD = dR @ R + R @ dR
            dB = dR + dD @ S @ R + D @ dS @ R + D @ S @ dR
            return -dB @ S - B @ dS, dB, dD

        U = np.array([complex(y[0], y[1]), complex(y[2], y[3])])
        f, f_rate = drive * V_D, drive * V_rate
        J = np.zeros((26, 26))

        def block(row, column, z):
            J[row:row + 2, column:column + 2] = [[z.real, -z.imag],
                                                 [z.imag, z.real]]

        def column(row, j, z):
            J[row, j] += z.real
            J[row + 1, j] += z.imag

        wf, wo = l["w_f"], l["w_o"]
        dT = y[NODES + 4] - T0
        turn = cmath.exp(1j * (p["phase_tc"] + p["phase_tc2"] * dT) * dT)
        gain_r = wf * turn / self.axis
        for i in range(2):
            for j in range(2):
                block(2 * i, 2 * j, A[i, j])
            h = feedback[i]
            J[4, 2 * i:2 * i + 2] = wf * h.real, -wf * h.imag
            J[5, 2 * i:2 * i + 2] = -wf * h.imag, -wf * h.real
            J[4 + i, 4 + i] = J[6 + i, 6 + i] = -wf
            J[6 + i, 4 + i] = wf
            block(10, 2 * i, gain_r * readout[i])
        for k, corner in [(10, wf), (12, wf), (14, wo), (16, wo)]:
            block(k, k, complex(-corner))
            if k > 10:
                block(k, k - 2, complex(corner))
        dA, dB, dD = slopes(2j * one, -2 * w * one + 1j * V)
        per_w = dA @ U + dB @ f - dD @ f_rate
        per_V, per_V_rate = B @ drive, -D @ drive
        scale = 0.0 if limited else l["V_0"]
        for k in range(6):  # i1 q1 i2 q2 xi eta
            error = frequency = amplitude = voltage = voltage_rate = 0.0
            if k < 4 and a > 1e-12:
                along = y[6 + k % 2] / a
                if k < 2:
                    voltage_rate = -l["K_pA"] * wf * along
                else:
                    turning = (y[7], -y[6])[k - 2] / (a * a)
                    error = gain * turning + gain_slope * along * phase
                    amplitude = -along
                    voltage = -l["K_pA"] * along
                    voltage_rate = l["K_pA"] * (
                        -wf * (y[4 + k - 2] - 2 * y[4 + k]) / a
                        - e_rate * along / a) - l["K_iA"] * along
            frequency = l["K_p"] * error + (k == 4)
            voltage += k == 5
            dU = (per_w * frequency + per_V * voltage * scale
                  + per_V_rate * voltage_rate * scale)
            column(0, 4 + k, dU[0])
            column(2, 4 + k, dU[1])
            column(10, 4 + k, gain_r * l["feedthrough"] * voltage * scale)
            J[8, 4 + k] += l["K_i"] * error
            J[9, 4 + k] += l["K_iA"] * amplitude
        dA, dB, dD = slopes(dV, dK + 1j * w * dV)
        dU = (dA @ U + dB @ f - dD @ f_rate + B @ d_drive * V_D
              - D @ d_drive * V_rate)
        column(0, NODES, dU[0])
        column(2, NODES, dU[1])
        h = d_feedback @ U
        J[4, NODES], J[5, NODES] = wf * h.real, -wf * h.imag
        column(10, NODES, gain_r * (d_readout @ U))
        charge = readout @ U + l["feedthrough"] * V_D
        column(10, NODES + 4, gain_r * charge * 1j
               * (p["phase_tc"] + 2 * p["phase_tc2"] * dT))
        J[NODES:, NODES:] = self.exchange
        d = abs(y[NODES + 3] - T0)
        J[NODES + 3, NODES + 3] -= (
            1.25 * self.t["natural"] * d ** 0.25
            + 4 * self.t["radiation"] * y[NODES + 3] ** 3
            + self.t["fixture"]) / self.t["housing_capacity"]
        return J

    def start(self):
        y = np.zeros(26)
        y[NODES:] = T0
        return y


ENVELOPE_WEIGHTS = np.array(
    [0.3] * 2 + [2e-3] * 2 + [0.3] * 4 + [100, 0.3] + [1.0] * 10 + [50.0] * 6)


class Carrier:
    """(2.1) with the loops, at T_0 and at rest."""

    def __init__(self, p):
        envelope = Envelope(p, lambda t: 0.0)
        self.l = p["loops"]
        m, _ = envelope.modal(T0)
        self.drive, self.feedback, self.readout = envelope.couplings(m)
        self.K, self.V = envelope.forces(m, 0.0)
        self.axis = envelope.axis
        self.loops = envelope.loops
        self.evaluations = 0

    def rhs(self, t, y):
        self.evaluations += 1
        y = y.tolist()
        l, K, V = self.l, self.K, self.V
        a, _, _, _, delta, w_d, V_D, _, _, _ = self.loops(y)
        w = l["w_nom"]
        e = cmath.exp(1j * (w * t + y[20]))
        back = 2 * e.conjugate()
        x0, x1, v0, v1 = y[:4]
        U = back * (self.feedback[0] * x0 + self.feedback[1] * x1)
        r = back * (self.readout[0] * x0 + self.readout[1] * x1
                    + l["feedthrough"] * V_D * e.real) / self.axis
        wf, wo = l["w_f"], l["w_o"]
        return np.array((
            w * v0, w * v1,
            ((self.drive[0] * e).real * V_D - K[0] * x0 - K[1] * x1) / w
            - V[0] * v0 - V[1] * v1,
            ((self.drive[1] * e).real * V_D - K[2] * x0 - K[3] * x1) / w
            - V[2] * v0 - V[3] * v1,
            wf * (U.real - y[4]), wf * (-U.imag - y[5]),
            wf * (y[4] - y[6]), wf * (y[5] - y[7]),
            l["K_i"] * delta, l["K_iA"] * (1 - a),
            wf * (r.real - y[10]), wf * (r.imag - y[11]),
            wf * (y[10] - y[12]), wf * (y[11] - y[13]),
            wo * (y[12] - y[14]), wo * (y[13] - y[15]),
            wo * (y[14] - y[16]), wo * (y[15] - y[17]), 0, 0, w_d - w))


def run(model, method, tolerance, weights, start, times, exact, jacobian):
    model.evaluations = 0
    options = {"jac": jacobian} if method in ("Radau", "BDF", "LSODA") else {}
    began = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        answer = solve_ivp(model.rhs, (0, times[-1]), start, method,
                           t_eval=times, rtol=3e-14, atol=tolerance * weights,
                           **options)
    took = time.perf_counter() - began
    if not answer.success:
        return None
    error = np.abs(answer.y[16] / DEGREE - exact).max()
    return took, model.evaluations, error


def compare(title, ours, model, weights, start, times, methods, jacobian=None):
    exact = np.array(ours["output"])
    print(f"\n{title}\n{'':12}{'evaluations':>12}{'time s':>10}"
          f"{'error deg/s':>13}")
    print(f"{'ours':12}{ours['rhs']:>12}{ours['seconds']:>10.4f}"
          f"{ours['error']:>13.1e}")
    best = math.inf
    for method, tolerances in methods.items():
        points = []
        for tolerance in tolerances:
            found = run(model, method, tolerance, weights, start, times, exact,
                        jacobian)
            if found is None:
                continue
            points.append((math.log(found[2]), math.log(found[0])))
            print(f"{method:12}{found[1]:>12}{found[0]:>10.3f}{found[2]:>13.1e}",
                  flush=True)
        if len(points) > 1:
            # At our error, along the line through the two nearest points.
            wanted = math.log(ours["error"])
            (x0, y0), (x1, y1) = sorted(
                points, key=lambda point: abs(point[0] - wanted))[:2]
            at = y0 if x0 == x1 else y0 + (y1 - y0) * (wanted - x0) / (x1 - x0)
            best = min(best, math.exp(at))
    print(f"best of SciPy at our error {best:.3f} s: "
          f"{best / ours['seconds']:.0f} times ours")


def main():
    build = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        recording = f"{folder}/run.h5"
        subprocess.run([build / "beamgyro", "run",
                        ROOT / "scenarios/start_up.toml", "-o", recording],
                       check=True)
        text = subprocess.run([build / "bench/beamgyro_model", recording],
                              check=True, capture_output=True).stdout
    model = json.loads(text)
    p = model["parameters"]

    probe = model["envelope_probe"]
    envelope = Envelope(p, lambda t: 0.1)
    state = np.array(probe["state"])
    scale = np.abs(probe["rate"]) + 1
    print("right-hand sides agree to",
          f"{np.max(np.abs(envelope.rhs(0, state) - probe['rate']) / scale):.1e}"
          " (envelope),", end=" ")
    exact = np.array(probe["jacobian"])
    apart = np.abs(envelope.jacobian(0, state) - exact)
    print(f"{np.max(apart / (np.abs(exact).max(axis=0) + 1)):.1e} (Jacobian),",
          end=" ")
    carrier = Carrier(p)
    probe = model["carrier"]
    found = carrier.rhs(1e-5, np.array(probe["probe"]))
    scale = np.abs(probe["probe_rate"]) + 1
    print(f"{np.max(np.abs(found - probe['probe_rate']) / scale):.1e} (carrier)")

    times = np.arange(15000) / 10
    implicit = {"Radau": [1e-6, 1e-7, 1e-8], "LSODA": [1e-7, 1e-8, 1e-9]}
    for name, rate in [
            ("envelope_at_rest", lambda t: 0.0),
            ("envelope_under_sine",
             lambda t: 10 * DEGREE * math.sin(0.1 * math.pi * t))]:
        envelope = Envelope(p, rate)
        compare(name.replace("_", " ") + ", 1500 s at 10 Hz", model[name],
                envelope, ENVELOPE_WEIGHTS, envelope.start(), times, implicit,
                envelope.jacobian)
    compare("carrier, 0.05 s at 2 kHz", model["carrier"], carrier,
            np.array(model["carrier"]["weights"]), np.zeros(21),
            np.arange(1, 101) * 5e-4,
            {"DOP853": [1e-5, 1e-6, 1e-7, 1e-8], "LSODA": [1e-7, 1e-9]})


if __name__ == "__main__":
    main()
