#!/usr/bin/env python3
"""Writes the logs of this folder, and beside each FILE.expected: what the reference reader (scipy.io, h5py, numpy; for ULog and DataFlash the
numbers that were written) says is in it. Needs Debian's python3-numpy, python3-scipy and python3-h5py; the tests need only the files.

FILE.expected: per channel a line  NAME <tab> UNIT <tab> CLOCK <tab> values as hexadecimal floats, separated by blanks."""

import pathlib
import struct
import sys

import h5py
import numpy as np
import scipy.io

here = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else __file__).resolve()
here = here if here.is_dir() else here.parent
rng = np.random.default_rng(20)
N = 40
t = 0.01 * np.arange(N)
w = np.cumsum(rng.normal(size=N))
u = np.sign(np.sin(20 * t))
xy = rng.normal(size=(N, 2))


def expect(file, channels):
    """channels: (name, unit, clock, values)"""
    lines = []
    for name, unit, clock, values in channels:
        numbers = " ".join(float(v).hex() for v in np.asarray(values))
        lines.append(f"{name}\t{unit}\t{clock}\t{numbers}\n")
    (here / (file + ".expected")).write_text("".join(lines))


# MAT, version 5, by scipy; the values as scipy reads them.
def mat_files():
    scipy.io.savemat(here / "plain.mat", {"t": t[:, None], "w": w[:, None], "u": u.astype(np.int8), "xy": xy, "text": "no number",
                                          "gain": 2.5, "on": (u > 0)[:, None], "big": np.arange(N, dtype=np.uint64) * 2**52},
                     do_compression=False)
    m = scipy.io.loadmat(here / "plain.mat")
    expect("plain.mat", [(k, "", "t", m[k].ravel()) for k in ("t", "w", "u")] +
           [("xy[0]", "", "t", m["xy"][:, 0]), ("xy[1]", "", "t", m["xy"][:, 1]), ("on", "", "t", m["on"].ravel()),
            ("big", "", "t", m["big"].ravel())])
    slow = 0.05 * np.arange(9)
    cells = np.empty(2, dtype=object)
    cells[0], cells[1] = w, t
    scipy.io.savemat(here / "structs.mat", {"motor": {"time_ms": 1e3 * t, "w": w.astype(np.float32), "signals": {"values": xy}},
                                            "slow": {"t": slow, "T": 20 + slow}, "c": cells,
                                            "z": w + 1j * w}, do_compression=True)
    m = scipy.io.loadmat(here / "structs.mat", squeeze_me=True)
    motor, s = m["motor"][()], m["slow"][()]
    expect("structs.mat", [("motor.time_ms", "", "motor.time_ms", motor["time_ms"]), ("motor.w", "", "motor.time_ms", motor["w"]),
                           ("motor.signals.values[0]", "", "motor.time_ms", motor["signals"][()]["values"][:, 0]),
                           ("motor.signals.values[1]", "", "motor.time_ms", motor["signals"][()]["values"][:, 1]),
                           ("slow.t", "", "slow.t", s["t"]), ("slow.T", "", "slow.t", s["T"]),
                           ("c{1}", "", "-", w), ("c{2}", "", "-", t)])
    # big-endian, which scipy reads and does not write
    def element(kind, data):
        return struct.pack(">II", kind, len(data)) + data + b"\0" * (-len(data) % 8)

    def matrix(name, kind, storage, values):
        dims = struct.pack(">2i", *values.shape)
        data = values.T.astype(values.dtype.newbyteorder(">")).tobytes()
        return element(14, element(6, struct.pack(">II", kind, 0)) + element(5, dims) + element(1, name) + element(storage, data))

    head = b"MATLAB 5.0 MAT-file, big-endian".ljust(124) + struct.pack(">H", 0x0100) + b"MI"
    body = matrix(b"t", 6, 9, t[:, None]) + matrix(b"w", 7, 7, w[:, None].astype(np.float32)) + matrix(b"n", 6, 3, np.arange(-3, N - 3, dtype=np.int16)[None, :])
    (here / "big_endian.mat").write_bytes(head + body)
    m = scipy.io.loadmat(here / "big_endian.mat")
    expect("big_endian.mat", [(k, "", "t", m[k].ravel()) for k in ("t", "w", "n")])


# MAT, version 7.3: HDF5 as MATLAB writes it.
def mat73_file():
    file = here / "version73.mat"
    with h5py.File(file, "w", userblock_size=512) as f:
        def put(group, name, values, kind=b"double", **more):
            d = group.create_dataset(name, data=values, **more)
            d.attrs["MATLAB_class"] = np.string_(kind)
        put(f, "t", t[None, :])
        put(f, "xy", xy.T, chunks=(2, 20), compression="gzip")
        put(f, "n", np.arange(N, dtype=np.int32)[None, :], b"int32")
        put(f, "title", np.frombuffer("ab".encode("utf-16-le"), dtype=np.uint16)[:, None], b"char")
        run = f.create_group("run")
        run.attrs["MATLAB_class"] = np.string_(b"struct")
        put(run, "w", w[None, :])
    raw = bytearray(file.read_bytes())
    raw[:124] = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124)
    raw[124:128] = b"\x00\x02IM"
    file.write_bytes(raw)
    with h5py.File(file) as f:
        expect(file.name, [("n", "", "t", f["n"][0]), ("run.w", "", "t", f["run/w"][0]), ("t", "", "t", f["t"][0]),
                           ("xy[0]", "", "t", f["xy"][0]), ("xy[1]", "", "t", f["xy"][1])])


def hdf5_files():
    with h5py.File(here / "plain.h5", "w") as f:
        f["time"] = t
        f["time"].attrs["units"] = "s"
        f["motor/w"] = w
        f["motor/w"].attrs["units"] = np.string_("rad/s")
        f["motor/u"] = u.astype(">i2")
        f["motor/xy"] = xy
        f["name"] = "no number"
    with h5py.File(here / "plain.h5") as f:
        expect("plain.h5", [("motor/u", "", "time", f["motor/u"][:]), ("motor/w", "rad/s", "time", f["motor/w"][:]),
                            ("motor/xy[0]", "", "time", f["motor/xy"][:, 0]), ("motor/xy[1]", "", "time", f["motor/xy"][:, 1]),
                            ("time", "s", "time", f["time"][:])])
    with h5py.File(here / "chunked.h5", "w", libver="latest") as f:
        f.create_dataset("a/t", data=t, chunks=(7,), compression="gzip", shuffle=True, fletcher32=True)
        f.create_dataset("a/w", data=w.astype(np.float32), chunks=(16,), maxshape=(None,))
        f.create_dataset("b/t", data=np.arange(5) * 0.1)
        f.create_dataset("b/on", data=np.array([True, False, True, True, False]))
    with h5py.File(here / "chunked.h5") as f:
        expect("chunked.h5", [(n, "", n[0] + "/t", f[n][:]) for n in ("a/t", "a/w", "b/on", "b/t")])
    table = np.zeros(N, dtype=[("t", "<f8"), ("w", "<f4"), ("count", ">i8"), ("name", "S4")])
    table["t"], table["w"], table["count"] = t, w, np.arange(N)
    with h5py.File(here / "table.h5", "w") as f:
        f.create_dataset("log/table", data=table)
    with h5py.File(here / "table.h5") as f:
        expect("table.h5", [("log/table/" + n, "", "log/table/t", f["log/table"][n]) for n in ("t", "w", "count")])


def numpy_files():
    np.save(here / "columns.npy", np.column_stack([t, w, u]).astype("<f4"))
    a = np.load(here / "columns.npy")
    expect("columns.npy", [(f"columns[{j}]", "", "-", a[:, j]) for j in range(3)])
    np.save(here / "fortran.npy", np.asfortranarray(np.column_stack([w, u]).astype(">i2")))
    a = np.load(here / "fortran.npy")
    expect("fortran.npy", [(f"fortran[{j}]", "", "-", a[:, j]) for j in range(2)])
    record = np.zeros(N, dtype=[("t", "<f8"), ("w[rad/s]", ">f4"), ("xy", "<f2", (2,)), ("on", "?"), ("name", "U3")])
    record["t"], record["w[rad/s]"], record["xy"], record["on"] = t, w, xy, u > 0
    np.save(here / "records.npy", record)
    a = np.load(here / "records.npy")
    expect("records.npy", [("t", "", "t", a["t"]), ("w", "rad/s", "t", a["w[rad/s]"]), ("xy[0]", "", "t", a["xy"][:, 0]),
                           ("xy[1]", "", "t", a["xy"][:, 1]), ("on", "", "t", a["on"])])
    when = np.datetime64("2026-01-02T03:04:05", "ns") + (t * 1e9).astype("timedelta64[ns]")
    arrays = {"time": when, "w": w, "xy": xy, "slow/t": np.arange(6) * 0.1, "slow/T": np.arange(6, dtype=np.uint8)}
    for name, save in (("stored.npz", np.savez), ("deflated.npz", np.savez_compressed)):
        save(here / name, **arrays)
        a = np.load(here / name)
        expect(name, [("time", "ns", "time", a["time"].astype(np.int64)), ("w", "", "time", a["w"]), ("xy[0]", "", "time", a["xy"][:, 0]),
                      ("xy[1]", "", "time", a["xy"][:, 1]), ("slow/t", "", "slow/t", a["slow/t"]), ("slow/T", "", "slow/t", a["slow/T"])])
    np.savez(here / "one.npz", t=t.astype(np.float16), w=w.astype(np.int64), empty=np.zeros(0), single=3.0, cube=np.zeros((3, 3, 3)))
    a = np.load(here / "one.npz")
    expect("one.npz", [("t", "", "t", a["t"]), ("w", "", "t", a["w"])])


# ULog, by the description of the format in the PX4 guide.
class ULog:
    def __init__(self):
        self.data = b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 1000)

    def message(self, kind, content):
        self.data += struct.pack("<HB", len(content), ord(kind)) + content

    def flags(self, appended=()):
        offsets = list(appended) + [0] * (3 - len(appended))
        self.message("B", bytes(8) + bytes([1 if appended else 0]) + bytes(7) + struct.pack("<3Q", *offsets))

    def format(self, text):
        self.message("F", text.encode())

    def add(self, number, name, instance=0):
        self.message("A", struct.pack("<BH", instance, number) + name.encode())

    def record(self, number, layout, *values):
        self.message("D", struct.pack("<H", number) + struct.pack("<" + layout, *values))


SYNC = bytes([0x2F, 0x73, 0x13, 0x20, 0x25, 0x0C, 0xBB, 0x12])


def single(x):
    return np.float32(x)


def ulog_files():
    log = ULog()
    log.flags()
    log.message("I", bytes([12]) + b"char[3] name" + b"abc")
    log.format("motor:uint64_t timestamp;float[2] xy;int16_t u;bool on;uint8_t[5] _padding0;")
    log.add(3, "motor")
    us = (1e6 * t).astype(np.int64) + 1000
    for i in range(N):
        log.record(3, "Q2fh?", us[i], xy[i, 0], xy[i, 1], int(100 * u[i]), u[i] > 0)
    (here / "simple.ulg").write_bytes(log.data)
    expect("simple.ulg", [("motor.timestamp", "us", "motor.timestamp", us), ("motor.xy[0]", "", "motor.timestamp", single(xy[:, 0])),
                          ("motor.xy[1]", "", "motor.timestamp", single(xy[:, 1])), ("motor.u", "", "motor.timestamp", 100 * u),
                          ("motor.on", "", "motor.timestamp", u > 0)])

    log = ULog()
    log.flags()
    log.format("vector:float x;double y;char[4] label;")
    log.format("imu:uint64_t timestamp;vector[2] rate;int8_t n;")
    log.format("slow:uint64_t timestamp;uint32_t T;")
    log.add(0, "imu")
    log.add(1, "imu", 1)
    log.add(2, "slow")
    for i in range(N):
        for k in (0, 1):
            log.record(k, "Qfd4sfd4sb", us[i] + 7 * k, w[i], w[i], b"ab", u[i], xy[i, k], b"cd", i % 100)
        if i % 10 == 0:
            log.record(2, "QI", us[i] + 3, 20 + i)
            log.message("S", SYNC)
    log.message("O", struct.pack("<H", 12))
    (here / "instances.ulg").write_bytes(log.data)
    out = []
    for k, name in ((0, "imu"), (1, "imu[1]")):
        clock = name + ".timestamp"
        out += [(clock, "us", clock, us + 7 * k), (name + ".rate[0].x", "", clock, single(w)), (name + ".rate[0].y", "", clock, w),
                (name + ".rate[1].x", "", clock, single(u)), (name + ".rate[1].y", "", clock, xy[:, k]),
                (name + ".n", "", clock, np.arange(N))]
    out += [("slow.timestamp", "us", "slow.timestamp", us[::10] + 3), ("slow.T", "", "slow.timestamp", 20 + np.arange(0, N, 10))]
    expect("instances.ulg", out)

    # a part that was appended after a sudden end, and a stretch that is damaged
    log = ULog()
    log.flags()
    log.format("motor:uint64_t timestamp;float w;")
    log.add(7, "motor")
    kept = []
    for i in range(N):
        if i == 10:
            log.data += b"\xff" * 21
            log.message("S", SYNC)
        log.record(7, "Qf", us[i], w[i])
        kept.append(i)
    log.data += b"\x0e\x00D\x07"  # cut off
    begin = len(log.data)
    log.record(7, "Qf", us[-1] + 10000, 1.5)
    data = log.data.replace(bytes(8) + bytes([0]) + bytes(7) + bytes(24), bytes(8) + bytes([1]) + bytes(7) + struct.pack("<3Q", begin, 0, 0), 1)
    (here / "appended.ulg").write_bytes(data)
    expect("appended.ulg", [("motor.timestamp", "us", "motor.timestamp", np.append(us, us[-1] + 10000)),
                            ("motor.w", "", "motor.timestamp", np.append(single(w), 1.5))])


# DataFlash, by the description of the format in ArduPilot's AP_Logger.
SIZES = {"a": "64s", "b": "b", "B": "B", "h": "h", "H": "H", "i": "i", "I": "I", "f": "f", "d": "d", "n": "4s", "N": "16s", "Z": "64s", "c": "h",
         "C": "H", "e": "i", "E": "I", "L": "i", "M": "B", "q": "q", "Q": "Q", "g": "e"}


class DataFlash:
    def __init__(self):
        self.data, self.formats = b"", {}
        self.format(128, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns")

    def format(self, kind, name, letters, columns):
        layout = "<" + "".join(SIZES[c] for c in letters)
        self.formats[name] = (kind, layout)
        self.put("FMT", kind, 3 + struct.calcsize(layout), name.encode(), letters.encode(), columns.encode())

    def put(self, name, *values):
        kind, layout = self.formats[name]
        self.data += bytes([0xA3, 0x95, kind]) + struct.pack(layout, *values)


def dataflash_files():
    us = (1e6 * t).astype(np.int64) + 5000
    log = DataFlash()
    log.format(129, "UNIT", "QbZ", "TimeUS,Id,Label")
    log.format(130, "MULT", "Qbd", "TimeUS,Id,Mult")
    log.format(131, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds")
    log.format(140, "IMU", "QBffh", "TimeUS,I,GyrX,AccX,T")
    log.format(141, "BAT", "QfN", "TimeUS,Volt,Name")
    for letter, label in (("s", b"s"), ("#", b"instance"), ("E", b"rad/s"), ("o", b"m/s/s"), ("O", b"degC"), ("v", b"V")):
        log.put("UNIT", 0, ord(letter), label)
    for letter, factor in (("F", 1e-6), ("-", 0), ("0", 1), ("C", 1e-3)):
        log.put("MULT", 0, ord(letter), factor)
    log.put("FMTU", 0, 140, b"s#EoO", b"F-000")
    log.put("FMTU", 0, 141, b"sv-", b"FC-")
    for i in range(N):
        for k in (0, 1):
            log.put("IMU", us[i] + k, k, w[i], xy[i, k], 20 + i)
        if i % 8 == 0:
            log.put("BAT", us[i], 12000 + i, b"main")
    (here / "instances.bin").write_bytes(log.data)
    out = []
    for k in (0, 1):
        clock = f"IMU[{k}].TimeUS"
        out += [(clock, "us", clock, us + k), (f"IMU[{k}].I", "instance", clock, np.full(N, k)), (f"IMU[{k}].GyrX", "rad/s", clock, single(w)),
                (f"IMU[{k}].AccX", "m/s/s", clock, single(xy[:, k])), (f"IMU[{k}].T", "degC", clock, 20 + np.arange(N))]
    out += [("BAT.TimeUS", "us", "BAT.TimeUS", us[::8]), ("BAT.Volt", "mV", "BAT.TimeUS", 12000 + np.arange(0, N, 8))]
    expect("instances.bin", out)

    log = DataFlash()
    log.format(20, "INT", "IbBhHiIqQcCeELMn", "TimeMS,b,B,h,H,i,I,q,Q,c,C,e,E,L,M,n")
    log.format(21, "REAL", "IfdgNa", "TimeMS,f,d,g,N,a")
    rows = []
    for i in range(N):
        rows.append([10 * i, i - 20, i, -300 * i, 300 * i, -70000 * i, 70000 * i, -(2**40) * i, 2**40 * i, -7 * i, 7 * i, -70001 * i, 70001 * i,
                     473977429 + i, 5])
        log.put("INT", *rows[-1], b"name")
        log.put("REAL", 10 * i + 1, w[i], w[i], xy[i, 0], b"no number", b"")
    (here / "letters.bin").write_bytes(log.data)
    a = np.array(rows, dtype=np.float64)
    for j, divisor in ((9, 100), (10, 100), (11, 100), (12, 100), (13, 1e7)):
        a[:, j] /= divisor
    names = "TimeMS,b,B,h,H,i,I,q,Q,c,C,e,E,L,M".split(",")
    ms, clock = 10 * np.arange(N) + 1, "REAL.TimeMS"
    expect("letters.bin", [("INT." + n, "ms" if n == "TimeMS" else "", "INT.TimeMS", a[:, j]) for j, n in enumerate(names)] +
           [(clock, "ms", clock, ms), ("REAL.f", "", clock, single(w)), ("REAL.d", "", clock, w),
            ("REAL.g", "", clock, xy[:, 0].astype(np.float16))])

    log = DataFlash()
    log.format(50, "MOT", "Qfg", "TimeUS,w,u")
    kept = [i for i in range(N) if i != 12]
    for i in range(N):
        if i == 12:
            log.data += b"\xa3\x95\x32\x00\x11\x22" + b"\x00" * 5  # a message that was lost
        else:
            log.put("MOT", us[i], w[i], xy[i, 0])
    log.data += b"\xa3\x95\x32\x01"
    (here / "damaged.bin").write_bytes(log.data)
    expect("damaged.bin", [("MOT.TimeUS", "us", "MOT.TimeUS", us[kept]), ("MOT.w", "", "MOT.TimeUS", single(w)[kept]),
                           ("MOT.u", "", "MOT.TimeUS", xy[kept, 0].astype(np.float16))])


mat_files()
mat73_file()
hdf5_files()
numpy_files()
ulog_files()
dataflash_files()
