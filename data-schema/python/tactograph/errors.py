# SPDX-License-Identifier: GPL-3.0-or-later
"""The error of the readers."""


class FileProblem(ValueError):
    """A file that cannot be read: what is wrong, where, and what to do."""

    def __init__(self, what, where, remedy=""):
        super().__init__(f"{where}: {what}" + (f"; {remedy}" if remedy else ""))
        self.what, self.where, self.remedy = what, str(where), remedy
