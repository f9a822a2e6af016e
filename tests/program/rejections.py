# SPDX-License-Identifier: MIT
"""Tables of commands that are refused: a test for each row, one folder for all."""

import dataclasses
import shlex

from program import ProgramTest


@dataclasses.dataclass(frozen=True)
class Row:
    words: list  # of the command
    says: tuple  # parts of its message
    files: dict  # that only this row has: a text, bytes, or what makes the path
    status: int
    name: str


def row(words, *says, files=None, status=2, name=""):
    """A row; `words` are a list, or a text with the quotes of a shell."""
    words = shlex.split(words) if isinstance(words, str) else [*words]
    return Row(words, says, files or {}, status,
               f"{shlex.join(words)} {name}")


class Rejections(ProgramTest):
    """The rows of `table`, tried in one folder that prepare() fills and that each
    leaves as it was."""
    table = ()

    def __init_subclass__(cls, **options):
        super().__init_subclass__(**options)
        for one in cls.table:
            test = f"test {ascii(one.name)[1:-1]}"
            assert not hasattr(cls, test), f"{test} stands twice"
            setattr(cls, test, lambda self, one=one: self.refuse(one))

    def setUp(self):
        self.dir = self.kept

    def refuse(self, one):
        replaced = {name: (self.dir / name).read_bytes() for name in one.files
                    if (self.dir / name).is_file()}
        for name, content in one.files.items():
            if callable(content):
                content(self.dir / name)
            else:
                self.write(name, content)
        try:
            self.rejected(*one.words, says=one.says, status=one.status)
        finally:
            for name in one.files:
                (self.dir / name).unlink()
            for name, content in replaced.items():
                self.write(name, content)
