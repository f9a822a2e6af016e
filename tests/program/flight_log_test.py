# SPDX-License-Identifier: MIT
"""scripts/flight_log_to_csv.py, on ULog and DataFlash logs that this test
writes as their public specifications state."""

import random
import re
import struct
import sys
import time

import numpy as np

from program import ROOT, ProgramTest

SCRIPT = ROOT / "scripts/flight_log_to_csv.py"
GYRO = ("uint64_t timestamp;uint64_t timestamp_sample;uint32_t device_id;"
        "float x;float y;float z;float temperature;uint32_t error_count;"
        "uint8_t[3] clip_counter;uint8_t[5] _padding0;")
SAMPLE = struct.Struct("<QQIffffI3B")  # the last padding is not written


def ulog_message(kind, body):
    return struct.pack("<Hc", len(body), kind) + body


def ulog(samples, instances=(0, 1)):
    """A log with flags, formats, an unrelated nested topic, a sync message, a
    dropout, and the samples of every instance in turn."""
    data = b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 112233)
    data += ulog_message(b"B", bytes(40))
    data += ulog_message(b"F", b"inner:float[2] p;")
    data += ulog_message(b"F", b"other:uint64_t timestamp;inner[2] parts;")
    data += ulog_message(b"F", b"sensor_gyro:" + GYRO.encode())
    data += ulog_message(b"I", b"\x0bchar[3] sys" + b"PX4")
    data += ulog_message(b"A", struct.pack("<BH", 0, 9) + b"other")
    for instance in instances:
        data += ulog_message(b"A", struct.pack("<BH", instance, 20 + instance)
                             + b"sensor_gyro")
    data += ulog_message(b"S", bytes.fromhex("2f73132025") + b"\xbb" * 3)
    for k in range(samples):
        data += ulog_message(b"D", struct.pack("<HQ4f", 9, k, 1, 2, 3, 4))
        for instance in instances:
            at = 5000000 + 4000 * k
            data += ulog_message(b"D", struct.pack("<H", 20 + instance) +
                                 SAMPLE.pack(at + 150, at, 2490378,
                                             0.01 * k + instance, -0.02, 0.03,
                                             40 + 0.01 * k, 0, 0, 0, 0))
    data += ulog_message(b"O", struct.pack("<H", 12))
    return data


def fmt(number, name, letters, labels):
    size = 3 + struct.calcsize("<" + letters.replace("c", "h").replace(
        "Z", "64s").replace("M", "B").replace("n", "4s").replace("N", "16s"))
    return b"\xa3\x95\x80" + struct.pack(
        "<BB4s16s64s", number, size, name.encode(), letters.encode(),
        labels.encode())


IMU = "QBffffffIIfBBHH"
IMU_LABELS = "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz"


def dataflash(samples, instances=(0, 1)):
    data = fmt(128, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns")
    data += fmt(41, "IMU", IMU, IMU_LABELS)
    data += fmt(42, "BARO", "Qfc", "TimeUS,Alt,Temp")
    for k in range(samples):
        at = 1000000 + 2500 * k
        data += b"\xa3\x95\x2a" + struct.pack("<Qfh", at, 12.5, 3125)
        for i in instances:
            data += b"\xa3\x95\x29" + struct.pack(
                "<" + IMU, at, i, 0.1, 0.2 + i, -0.01 * k, 0, 0, -9.81, 0, 0,
                31.5 + i, 1, 1, 1000, 1000)
    return data


class FlightLogs(ProgramTest):
    def converted(self, log, *arguments):
        return self.ok(SCRIPT, log, *arguments, program=sys.executable)

    def refused(self, data, says, *arguments):
        self.write("bad.bin", data)
        return self.rejected(
            SCRIPT, "bad.bin", *arguments, program=sys.executable, says=says,
            status=1)

    def imported(self, name, axis):
        self.ok("import", f"{name}.csv", "--map", f"{name}.toml", "--axis",
                axis, "-o", f"{name}.h5")
        return self.signals(f"{name}.h5")

    def test_a_ulog_file(self):
        self.write("flight.ulg", ulog(50))
        self.assertIn("50 rows of sensor_gyro, instance 0; 1 dropouts",
                      self.converted("flight.ulg"))
        k = np.arange(50)
        values = self.imported("flight", "x")
        np.testing.assert_array_equal(values["time"], k * 4000 / 1e6)
        # The log holds floats, which nine digits tell apart.
        np.testing.assert_allclose(
            values["rate"], np.degrees((0.01 * k).astype("f4").astype("f8")),
            rtol=5e-9)
        np.testing.assert_array_equal(values["temperature"].astype("f4"),
                                      (40 + 0.01 * k).astype("f4"))
        self.converted("flight.ulg", "--instance", "1", "-o", "second")
        np.testing.assert_allclose(self.imported("second", "x")["rate"],
                                   np.degrees(1 + 0.01 * k), rtol=1e-6)

    def test_a_dataflash_log(self):
        self.write("flight.bin", dataflash(50))
        self.assertIn("50 rows of IMU, instance 0\n",
                      self.converted("flight.bin"))
        values = self.imported("flight", "z")
        np.testing.assert_array_equal(values["time"],
                                      np.arange(50) * 2500 / 1e6)
        np.testing.assert_allclose(values["rate"],
                                   np.degrees(-0.01 * np.arange(50)), rtol=1e-6)
        np.testing.assert_array_equal(values["temperature"], 31.5)
        self.converted("flight.bin", "--instance", "1", "-o", "second")
        values = self.imported("second", "y")
        np.testing.assert_array_equal(values["temperature"], 32.5)
        np.testing.assert_allclose(values["rate"], np.degrees(1.2), rtol=1e-6)

    def test_an_old_dataflash_log_with_a_message_for_each_imu(self):
        data = fmt(128, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns")
        for number, name in [(41, "IMU"), (43, "IMU2")]:
            data += fmt(number, name, "Qffff", "TimeUS,GyrX,GyrY,GyrZ,T")
        for k in range(10):
            data += b"\xa3\x95\x29" + struct.pack("<Qffff", 1000 * k, 1, 2, 3,
                                                  25)
            data += b"\xa3\x95\x2b" + struct.pack("<Qffff", 1000 * k, 4, 5, 6,
                                                  26)
        self.write("old.bin", data)
        self.converted("old.bin", "--instance", "1")
        np.testing.assert_array_equal(
            self.imported("old", "x")["temperature"], 26)

    def test_damaged_bytes_are_skipped_and_a_cut_log_ends_early(self):
        head = dataflash(0)
        rows = dataflash(50)[len(head):]
        size = len(rows) // 50
        self.write("cut.bin", head + rows[:10 * size] + b"\x00\xa3\xa3\x95\x07"
                   + rows[10 * size:-1])
        said = self.converted("cut.bin")
        # The last message of IMU lacks one byte.
        lost = 5 + 3 + struct.calcsize("<" + IMU) - 1
        self.assertIn(f"50 rows of IMU, instance 0; {lost} bytes that are no "
                      "whole message skipped\n", said)
        self.converted("cut.bin", "--instance", "1", "-o", "second")
        self.assertEqual(len(self.imported("second", "x")["time"]), 49)

    def test_a_ulog_that_is_cut_in_the_middle_of_a_message(self):
        whole = ulog(50)
        self.write("cut.ulg", whole[:-7])  # the dropout of five bytes, and two
        message = 5 + SAMPLE.size
        self.assertIn(f"50 rows of sensor_gyro, instance 0; {message - 2} bytes "
                      "that are no whole message skipped\n",
                      self.converted("cut.ulg"))
        self.converted("cut.ulg", "--instance", "1", "-o", "second")
        self.assertEqual(len(self.imported("second", "x")["time"]), 49)
        self.write("ends.ulg", whole[:-4])  # one byte of the dropout is left
        self.assertIn("50 rows of sensor_gyro, instance 0; 1 bytes",
                      self.converted("ends.ulg"))

    def test_a_damaged_ulog_is_read_on_behind_the_damage(self):
        head = len(ulog(0)) - 5  # without the dropout at its end
        data = ulog(50)
        message = 5 + SAMPLE.size
        size = (len(data) - 5 - head) // 50  # of all topics
        second = head + 11 * size - 2 * message  # instance 0 of row 10
        damaged = {
            # name: the log, rows of instance 0, bytes skipped
            "inserted": (data[:second] + b"\xff" * 7 + data[second:], 50, 7),
            "zeros": (data[:second] + bytes(message) + data[second + message:],
                      49, message),
            "removed": (data[:second + 20] + data[second + message - 9:], 49,
                        29),
            "size": (data[:second] + b"\xff\x00" + data[second + 2:], 49,
                     message),
            "number": (data[:second + 3] + b"\xee\xee" + data[second + 5:], 49,
                       message)}
        for name, (log, kept, skipped) in damaged.items():
            self.write(f"{name}.ulg", log)
            self.assertIn(
                f"{kept} rows of sensor_gyro, instance 0; 1 dropouts; "
                f"{skipped} bytes that are no whole message skipped\n",
                self.converted(f"{name}.ulg"))
            rows = self.text(f"{name}.csv").splitlines()
            times = [int(row.split(",")[0]) for row in rows[1:]]
            self.assertEqual(times, [5000000 + 4000 * k for k in range(50)
                                     if kept == 50 or k != 10])

    def test_bytes_that_look_as_messages_do_not_hide_true_ones(self):
        data, head = bytearray(ulog(2000)), len(ulog(0))
        noise = random.Random(1)
        for _ in range(100):
            at = noise.randrange(head, len(data) - 100)
            data[at:at + 40] = noise.randbytes(40)
        self.write("noise.ulg", bytes(data))
        said = self.converted("noise.ulg")
        # Forty bytes touch two messages at most, one of them of this gyro.
        self.assertGreaterEqual(int(re.search(r"(\d+) rows", said)[1]), 1900)
        self.assertRegex(said, r"; [3-9]\d{3} bytes that are no whole message")

    def test_a_message_of_a_newer_version_of_ulog_is_no_damage(self):
        data = ulog(50)
        head = len(ulog(0)) - 5
        self.write("new.ulg", data[:head] + ulog_message(b"Z", b"new" * 40)
                   + data[head:])
        self.assertIn("50 rows of sensor_gyro, instance 0; 1 dropouts\n",
                      self.converted("new.ulg"))

    def test_a_gyro_without_a_temperature(self):
        data = fmt(128, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns")
        data += fmt(44, "GYR", "QBfff", "TimeUS,I,GyrX,GyrY,GyrZ")
        for k in range(10):
            data += b"\xa3\x95\x2c" + struct.pack("<QBfff", 1000 * k, 0, 1, 2,
                                                  3)
        self.write("fast.bin", data)
        self.converted("fast.bin", "--topic", "GYR")
        self.assertEqual(set(self.imported("fast", "x")),
                         {"time", "rate", "status"})

    def test_logs_that_cannot_be_converted(self):
        self.refused(b"t,w,T\n0,1,2\n", "neither a ULog file nor a DataFlash")
        self.refused(ulog(5), "it has other 0, sensor_gyro 0, sensor_gyro 1",
                     "--instance", "2")
        self.refused(ulog(0), "no samples of sensor_gyro")
        self.refused(dataflash(5), "it has BARO, IMU", "--topic", "GYR")
        self.refused(dataflash(5), "no column for x, y, z", "--topic", "BARO")
        flags = bytearray(ulog(5))
        flags[16 + 3 + 8] = 2
        self.refused(bytes(flags), "flags of a newer version")

    def test_formats_that_no_message_can_have_are_refused_at_once(self):
        log = ulog(5)

        def with_formats(**texts):
            bad = b"".join(ulog_message(b"F", f"{name}:{text}".encode())
                           for name, text in texts.items())
            first = log.index(b"sensor_gyro:") - 3
            size = 3 + len("sensor_gyro:") + len(GYRO)
            return log[:first] + bad + log[first + size:]

        def nested(levels, text, leaf="uint8_t a;"):
            names = ["sensor_gyro", *(f"n{k}" for k in range(1, levels))]
            return {**{name: text.format(f"n{k + 1}")
                       for k, name in enumerate(names)}, f"n{levels}": leaf}

        wide = {f"w{k}": f"uint8_t[60000] {'x' * 60000};" for k in range(20)}
        begin = time.monotonic()
        for formats, says in [
                ({"sensor_gyro": "uint64_t[1000000000] timestamp;"},
                 "sensor_gyro: 'uint64_t[1000000000] timestamp'"),
                ({"sensor_gyro": f"uint8_t[{'9' * 9000}] a;"}, "_gyro: 'uint8"),
                ({"sensor_gyro": "e[1000000000] a;", "e": ""}, "_gyro: 'e[1"),
                (nested(40, "{0} a;{0} b;"), "nests 17 deep"),
                (nested(40, "{0} a;{0} b;", ""), "nests 17 deep"),
                (nested(15, "{0}[9000] a;", ""), "than a log can"),
                (nested(15, "{0} a;{0} b;{0} c;{0} d;"), "than a log can"),
                ({"sensor_gyro": "sensor_gyro a;"}, "nests 17 deep"),
                ({"sensor_gyro": "w0 a;", **wide}, "w0: 'uint8_t[60000] xxx")]:
            self.assertLess(
                len(self.refused(with_formats(**formats), says)), 300)
        self.assertLess(time.monotonic() - begin, 9)
        # Another topic than the one that is read.
        other = log.replace(b"other:uint64_t timestamp;inner[2] parts;",
                            b"other:uint64_t[1000000000] timestamp;in;")
        self.write("other.ulg", other)
        self.assertIn("5 rows of sensor_gyro", self.converted("other.ulg"))

    def test_import_names_the_script_for_a_binary_log(self):
        self.write("map.toml", '[time]\nrate_Hz = 1\n[gyro]\ncolumn = 1\n'
                               'unit = "deg/s"\n')
        for data, kind in [(ulog(5), "a ULog file of PX4"),
                           (dataflash(5), "a DataFlash log of ArduPilot")]:
            self.write("flight.bin", data)
            self.rejected("import", "flight.bin", "--map", "map.toml", "-o",
                          "r.h5", says=[kind, "scripts/flight_log_to_csv.py"])
