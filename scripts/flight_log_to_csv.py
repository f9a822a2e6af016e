#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Makes a CSV of the gyro in a binary flight log, and the map to import it.

flight_log_to_csv.py LOG [-o NAME] [--instance K] [--topic TOPIC]

LOG is a ULog file of PX4 (.ulg) or a DataFlash log of ArduPilot (.bin); its
first bytes tell which. Writes NAME.csv and NAME.toml (default: LOG without its
ending), which `beamgyro import NAME.csv --map NAME.toml --axis z` reads.
--instance K takes the gyro K, from 0. --topic names the topic of ULog or the
message of DataFlash (default sensor_gyro, or IMU). Needs Python 3.8, no package.

The formats are public: https://docs.px4.io/main/en/dev_log/ulog_file_format
and https://ardupilot.org/dev/docs/code-overview-adding-a-new-log-message.html.
"""

import argparse
import csv
import pathlib
import re
import struct
import sys

MAP = """\
# Made by scripts/flight_log_to_csv.py of {topic}, instance {instance}.
#     beamgyro import {name}.csv --map {name}.toml --axis z -o RUN.h5
# Add what the vehicle did, if it is known:
#     [true_rate]
#     at_rest = true

[time]
column = "{time}"
unit = "us"

[gyro.x]
column = "{x}"
unit = "rad/s"

[gyro.y]
column = "{y}"
unit = "rad/s"

[gyro.z]
column = "{z}"
unit = "rad/s"
"""

TEMPERATURE = """
[temperature]
column = "{temperature}"
unit = "degC"
"""


class LogError(Exception):
    """A log that cannot be read; the text says why."""


def skipped_text(counts):
    return f"{counts['skipped']} bytes that are no whole message skipped" \
        if counts["skipped"] else ""


# --- ULog ---------------------------------------------------------------------

ULOG_MAGIC = b"ULog\x01\x12\x35"
ULOG_HEAD = 16  # bytes: magic, version, start
ULOG_TYPES = {"int8_t": "b", "uint8_t": "B", "int16_t": "h", "uint16_t": "H",
              "int32_t": "i", "uint32_t": "I", "int64_t": "q", "uint64_t": "Q",
              "float": "f", "double": "d", "bool": "?", "char": "c"}
ULOG_LEAST = {b"B": 40, b"F": 3, b"I": 2, b"M": 3, b"P": 2, b"Q": 3, b"A": 4,
              b"R": 2, b"D": 2, b"L": 9, b"C": 11, b"S": 8, b"O": 2}  # bytes
ULOG_KIND = re.compile(b"[FIMPQARDLCSO]")  # B is the first message only
ULOG_DEEPEST = 16
DATA_APPENDED = 1  # the one incompatible flag whose files can be read so


def spend(left, cost, place):
    if cost > left[0]:
        raise LogError(f"{place} makes more values than a log can hold")
    left[0] -= cost


def ulog_fields(name, formats, left, depth=0):
    """Name and struct letter of each value, nested ones flat, in bounded work."""
    if name not in formats or depth > ULOG_DEEPEST:
        why = f"nests {depth} deep" if name in formats else "is not defined"
        raise LogError(f"the format of {name[:60]} {why}")
    spend(left, len(formats[name]), name[:60])
    for field in filter(None, formats[name].split(";")):
        place = f"{name[:60]}: {field[:60]!r}"
        match = re.fullmatch(r"(\w+)(?:\[(\d+)\])? (\w+)", field)
        if match is None:
            raise LogError(f"{place} is no field")
        kind, label = match[1], match[3]
        count = int((match[2] or "1")[:12])  # of long numbers Python refuses
        spend(left, count * len(field), place)
        for index in range(count):
            own = f"{label}[{index}]" if match[2] else label
            if kind in ULOG_TYPES:
                yield own, ULOG_TYPES[kind]
                continue
            for inner, letter in ulog_fields(kind, formats, left, depth + 1):
                spend(left, len(own) + len(inner), place)
                yield f"{own}.{inner}", letter


def ulog_message_end(data, at, sizes):
    """The end of a whole message of a known kind that begins at a byte and has a
    size that it may have, else None."""
    if at + 3 > len(data):
        return None
    size, kind = struct.unpack_from("<Hc", data, at)
    end = at + 3 + size
    if end > len(data) or size < ULOG_LEAST.get(kind, end):
        return None
    if kind == b"D":
        number = struct.unpack_from("<H", data, at + 3)[0]
        low, high = sizes.get(number, (2, end))
        if not low <= size <= high:
            return None
    return end


def are_ulog_messages(data, at, sizes, count):
    """Whether so many messages follow each other, or all up to the end."""
    while count > 0 and at is not None and at < len(data):
        at = ulog_message_end(data, at, sizes)
        count -= 1
    return at is not None


def next_ulog_data(data, start, stop, sizes):
    """Where, in a range, the first of four messages in a row begins that is data
    of a subscription, else its end."""
    for match in re.finditer(b"D", data[start + 2:stop + 2]):
        at = start + match.start()
        number = int.from_bytes(data[at + 3:at + 5], "little")
        if number in sizes and are_ulog_messages(data, at, sizes, 4):
            return at
    return stop


def next_ulog_message(data, start, sizes):
    """Where the first of four messages in a row begins. Other bytes may look as
    a message that reaches up to a true one: then data begin within it."""
    for match in ULOG_KIND.finditer(data, start + 2):
        at = match.start() - 2
        if are_ulog_messages(data, at, sizes, 4):
            end = ulog_message_end(data, at, sizes)
            within = next_ulog_data(data, at + 1, end, sizes)
            return at if within == end else within
    return len(data)


def newer_ulog_message_end(data, at, sizes):
    """The end of a message of a kind that only a newer version has, else None."""
    kind = data[at + 2:at + 3]
    if not kind.isalpha() or kind in ULOG_LEAST:
        return None
    end = at + 3 + struct.unpack_from("<H", data, at)[0]
    follows = end <= len(data) and are_ulog_messages(data, end, sizes, 1)
    return end if follows else None


def ulog_messages(data, sizes, counts):
    """Kind and body of each message. Bytes that begin none are skipped up to the
    next four in a row, and counted, and so is a message that lacks bytes, within
    whose size data begin. `sizes` has the least and the greatest size of the
    data of each subscription so far."""
    at = ULOG_HEAD
    while at < len(data):
        end = (ulog_message_end(data, at, sizes)
               or newer_ulog_message_end(data, at, sizes))
        following = end
        if end is None:
            following = next_ulog_message(data, at + 1, sizes)
        elif data[at + 2:at + 3] != b"D" or not are_ulog_messages(
                data, end, sizes, 1):
            following = next_ulog_data(data, at + 1, end, sizes)
        if following == end:
            yield data[at + 2:at + 3], data[at + 3:end]
        else:
            counts["skipped"] += following - at
        at = following


def ulog_sizes(name, formats, left):
    """The least and the greatest size of the data of a topic, without and with
    the padding at its end; any, where its format is lost."""
    try:
        fields = list(ulog_fields(name, formats, left))
    except LogError:
        return 2, 65535
    whole, written = (struct.calcsize("<" + "".join(one[1] for one in some))
                      for some in (fields, without_padding(fields)))
    return 2 + written, 2 + whole


def without_padding(fields):
    """The fields that are written: the padding at the end is not."""
    while fields and fields[-1][0].startswith("_padding"):
        fields = fields[:-1]
    return fields


def read_ulog(data, topic, instance):
    """Names of the columns and the rows of one instance of a topic."""
    formats, sizes, ids, seen, dropouts = {}, {}, set(), set(), 0
    names, letters, rows, layout = [], "", [], None
    counts, left = {"skipped": 0}, [1 << 22]  # left to work on
    for kind, body in ulog_messages(data, sizes, counts):
        if kind == b"B" and any(flag & ~(DATA_APPENDED if i == 0 else 0)
                                for i, flag in enumerate(body[8:16])):
            raise LogError("flags of a newer version of ULog")
        if kind == b"F":
            name, _, fields = body.decode("ascii", "replace").partition(":")
            formats[name] = fields
        elif kind == b"A":
            multi, number = struct.unpack_from("<BH", body)
            name = body[3:].decode("ascii", "replace")
            seen.add((name, multi))
            sizes[number] = ulog_sizes(name, formats, left)
            if (name, multi) == (topic, instance):
                ids.add(number)
                fields = without_padding([*ulog_fields(topic, formats, left)])
                names = [label for label, _ in fields]
                letters = "".join(letter for _, letter in fields)
                layout = struct.Struct("<" + letters)
        elif kind == b"D":
            number = struct.unpack_from("<H", body)[0]
            if number in ids:
                rows.append(layout.unpack_from(body, 2))
            elif number not in sizes:
                counts["skipped"] += 3 + len(body)
        elif kind == b"O":
            dropouts += 1
    if not ids:
        has = ", ".join(f"{name} {multi}" for name, multi in sorted(seen))
        raise LogError(f"no {topic} of instance {instance}; it has " +
                       (has[:2000] or "no topic"))
    dropped = f"{dropouts} dropouts" if dropouts else ""
    return names, letters, rows, "; ".join(
        note for note in [dropped, skipped_text(counts)] if note)


# --- DataFlash ----------------------------------------------------------------

DATAFLASH_HEAD = b"\xA3\x95"
FMT, FMT_SIZE = 128, 89  # the message that defines the others
# Letter of a format: letter of struct, and what the number is divided by.
DATAFLASH_TYPES = {"a": ("64s", 0), "b": ("b", 0), "B": ("B", 0),
                   "h": ("h", 0), "H": ("H", 0), "i": ("i", 0), "I": ("I", 0),
                   "f": ("f", 0), "d": ("d", 0), "g": ("e", 0), "n": ("4s", 0),
                   "N": ("16s", 0), "Z": ("64s", 0), "c": ("h", 100),
                   "C": ("H", 100), "e": ("i", 100), "E": ("I", 100),
                   "L": ("i", 0), "M": ("B", 0), "q": ("q", 0), "Q": ("Q", 0)}


class DataFlashMessage:
    """Layout of one kind of message, as its FMT defines it."""

    def __init__(self, body):
        text = [part.split(b"\0")[0].decode("ascii", "replace")
                for part in struct.unpack("<4s16s64s", body[2:86])]
        self.name, letters, labels = text
        self.size = body[1]
        self.labels = labels.split(",") if labels else []
        kinds = [DATAFLASH_TYPES.get(letter, ("", 0)) for letter in letters]
        self.letters = "".join(kind for kind, _ in kinds)
        self.divisors = [divisor for _, divisor in kinds]
        self.layout = struct.Struct("<" + self.letters)
        self.whole = (all(kind for kind, _ in kinds)
                      and len(self.labels) == len(kinds)
                      and self.layout.size + 3 == self.size)

    def row(self, data, at):
        values = self.layout.unpack_from(data, at)
        return tuple(value / divisor if divisor else value for value, divisor
                     in zip(values, self.divisors))


def dataflash_rows(data, counts):
    """Message and values of each record. Bytes that begin none are skipped up
    to the next one and counted, those of an incomplete one at the end too."""
    kinds, at = {}, 0
    while at + 3 <= len(data):
        number = data[at + 2]
        size = FMT_SIZE if number == FMT else getattr(kinds.get(number), "size",
                                                      0)
        if data[at:at + 2] != DATAFLASH_HEAD or size < 3:
            following = data.find(DATAFLASH_HEAD, at + 1)
            following = len(data) if following < 0 else following
            counts["skipped"] += following - at
            at = following
            continue
        if at + size > len(data):
            break
        if number == FMT:
            body = data[at + 3:at + size]
            kinds[body[0]] = DataFlashMessage(body)
        elif kinds[number].whole:
            yield kinds[number], kinds[number].row(data, at + 3)
        at += size
    counts["skipped"] += len(data) - at


def read_dataflash(data, topic, instance):
    """The same of a DataFlash log. Old logs have IMU, IMU2 and IMU3 in place of
    the number I of the instance."""
    counts, seen = {"skipped": 0}, set()
    old = topic if instance == 0 else f"{topic}{instance + 1}"
    message, rows = None, []
    for kind, row in dataflash_rows(data, counts):
        seen.add(kind.name)
        numbered = kind.name == topic and "I" in kind.labels
        if numbered and row[kind.labels.index("I")] != instance:
            continue
        if numbered or (kind.name == old and "I" not in kind.labels):
            message = kind
            rows.append(row)
    if message is None:
        raise LogError(f"no {topic} of instance {instance}; it has " +
                       (", ".join(sorted(seen)) or "no message"))
    return message.labels, message.letters, rows, skipped_text(counts)


# --- Both ---------------------------------------------------------------------

def shown(value, letter):
    """A number with the digits that its type holds."""
    if letter in "fe":
        return f"{value:.9g}"
    return repr(value) if letter == "d" or isinstance(value, float) \
        else str(int(value))


def columns_of(names):
    """Columns of the map by what they mean, and of the CSV in order."""
    def first(*wanted):
        return next((name for name in wanted if name in names), None)

    found = {"time": first("timestamp_sample", "timestamp", "TimeUS"),
             "x": first("x", "GyrX"), "y": first("y", "GyrY"),
             "z": first("z", "GyrZ"), "temperature": first("temperature", "T")}
    missing = [key for key, name in found.items()
               if name is None and key != "temperature"]
    if missing:
        raise LogError(f"no column for {', '.join(missing)}; it has "
                       f"{', '.join(names)[:2000]}")
    return found


def convert(path, name, instance, topic):
    data = path.read_bytes()
    if data.startswith(ULOG_MAGIC):
        topic = topic or "sensor_gyro"
        names, letters, rows, note = read_ulog(data, topic, instance)
    elif data.startswith(DATAFLASH_HEAD):
        topic = topic or "IMU"
        names, letters, rows, note = read_dataflash(data, topic, instance)
    else:
        raise LogError("neither a ULog file nor a DataFlash log")
    found = columns_of(names)
    if not rows:
        raise LogError(f"no samples of {topic}, instance {instance}")
    kinds = re.findall(r"\d*\D", letters)
    taken = [(names.index(column), kinds[names.index(column)])
             for column in found.values() if column]
    with open(f"{name}.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([names[index] for index, _ in taken])
        writer.writerows([shown(row[index], letter) for index, letter in taken]
                         for row in rows)
    text = MAP + (TEMPERATURE if found["temperature"] else "")
    pathlib.Path(f"{name}.toml").write_text(text.format(
        topic=topic, instance=instance, name=pathlib.Path(name).name, **found))
    return f"{name}.csv, {name}.toml: {len(rows)} rows of {topic}, instance " \
           f"{instance}" + (f"; {note}" if note else "")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log", type=pathlib.Path)
    parser.add_argument("-o", "--output", metavar="NAME")
    parser.add_argument("--instance", type=int, default=0, metavar="K")
    parser.add_argument("--topic")
    arguments = parser.parse_args()
    name = arguments.output or str(arguments.log.with_suffix(""))
    try:
        print(convert(arguments.log, name, arguments.instance, arguments.topic))
    except (LogError, OSError) as error:
        sys.exit(f"flight_log_to_csv.py: {arguments.log}: {error}")
    except struct.error as error:
        sys.exit(f"flight_log_to_csv.py: {arguments.log}: damaged: {error}")


if __name__ == "__main__":
    main()
