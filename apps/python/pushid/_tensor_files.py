"""Pickles of tensors, read without torch and without running what they name.

A pickle is a program: its globals name functions that a reader calls. Here the globals of a pickled tensor stand for
functions of this file, which make plain lists, and every other one is an error. A tensor's numbers are a file within
the file, as torch.save wrote it before 2020: pickles of a magic number, a protocol, the machine, a storage and its key,
then a count (8 bytes) and the numbers. That part may name storages and nothing else.
"""
import collections
import io
import math
import pickle
import struct

NUMBERS = {"DoubleStorage": "d", "FloatStorage": "f", "HalfStorage": "e", "LongStorage": "q", "IntStorage": "i",
           "ShortStorage": "h", "CharStorage": "b", "ByteStorage": "B"}  # torch's name, struct's letter
MAGIC, PROTOCOL = 0x1950A86A20F9469CFC6C, 1001


class Problem(Exception):
    """What is wrong with the input, where, and what to do."""


class Forbidden(Exception):
    pass


class _Storage(pickle.Unpickler):
    def find_class(self, module, name):
        if module == "torch" and name in NUMBERS:
            return name
        raise Forbidden(f"{module}.{name}")

    def persistent_load(self, pid):
        return pid


class _Tensors(_Storage):
    def find_class(self, module, name):
        if (module, name) == ("collections", "OrderedDict"):
            return collections.OrderedDict
        if (module, name) == ("torch._utils", "_rebuild_tensor_v2"):
            return lambda *arguments: _rows(*arguments)
        if (module, name) == ("torch.storage", "_load_from_bytes"):
            return lambda data: _numbers(data)
        return super().find_class(module, name)

    def persistent_load(self, pid):
        raise ValueError("it refers to data outside it")


def _numbers(data):
    """The numbers of a storage, from its bytes."""
    file = io.BytesIO(data)
    magic, protocol, machine, storage, keys = (_Storage(file).load() for _ in range(5))
    if magic != MAGIC or protocol != PROTOCOL or not machine["little_endian"]:
        raise ValueError("a storage of another format")
    kind, name, key, _, count = storage[:5]
    if kind != "storage" or keys != [key]:
        raise ValueError("a storage that is not alone")
    body, layout = file.read(), f"<{NUMBERS[name]}"
    if len(body) != 8 + count * struct.calcsize(layout) or struct.unpack("<q", body[:8]) != (count,):
        raise ValueError(f"a storage of {count} numbers in {len(body)} bytes")
    return [value for value, in struct.iter_unpack(layout, body[8:])]


def _rows(numbers, offset, size, stride, *_):
    """A matrix as a list of rows."""
    if len(size) != 2 or len(stride) != 2 or min((*size, *stride, offset)) < 0:
        raise ValueError(f"a tensor of size {tuple(size)}; expected rows and columns")
    last = offset + sum((n - 1) * step for n, step in zip(size, stride))
    if math.prod(size) > len(numbers) or (min(size) and last >= len(numbers)):
        raise ValueError(f"a tensor of size {tuple(size)} in a storage of {len(numbers)} numbers")
    rows = [[float(numbers[offset + i * stride[0] + j * stride[1]]) for j in range(size[1])] for i in range(size[0])]
    if not all(math.isfinite(value) for row in rows for value in row):
        raise ValueError("a tensor with a number that is not finite")
    return rows


def load(path):
    """What a pickle holds: plain containers, numbers, texts, and tensors as lists of rows."""
    try:
        with open(path, "rb") as file:
            return _Tensors(file).load()
    except OSError as error:
        raise Problem(f"{path}: {error.strerror}; is this a complete checkout of the release?") from None
    except Forbidden as error:
        raise Problem(f"{path}: the pickle asks for {error}, which is no part of a tensor and may run code; "
                      "nothing was run. Take the file from the release") from None
    except Exception as error:  # whatever damaged bytes lead to
        raise Problem(f"{path}: damaged, or no pickle of tensors ({error or type(error).__name__}); "
                      "take the file from the release") from None
