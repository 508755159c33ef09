"""How often 95 % intervals hold the truth where gains vary from recording to recording, and what the defaults cost.

coverage  ident/uncertainty/README.md; 7 minutes on one core

32 synthetic recordings a data set; tests/studies/coverage_study.cc says what varies. The profile and bootstrap
intervals are those of the first data sets only, which is why they are known to a few per cent.
"""
import studies

UNBIASED = ["--datasets=400", "--refined=20", "--num_threads=1"]
DEFAULTS = ["--datasets=400", "--refined=0", "--defaults", "--num_threads=1"]


def rows_of(arguments):
    text = studies.run("pushid-coverage-study", *arguments, out=None).text
    lines = text.splitlines()
    rows = {line.split()[0]: line.split()[1:] for line in lines[1:-1]}
    return rows, lines[-1]


def coverage():
    unbiased, told = rows_of(UNBIASED)
    defaults, _ = rows_of(DEFAULTS)
    rows = []
    for name, cells in unbiased.items():
        clustered, naive, profile, bootstrap, _, _ = cells
        rows.append([f"`{name}`", clustered, naive, profile, bootstrap, defaults[name][0], defaults[name][4]])
    text = studies.table(["coverage of 95 % intervals, %", "clustered", "naive", "profile", "bootstrap",
                          "clustered, with the default priors and settling", "their bias, in standard deviations"],
                         rows)
    return f"{text}\n\n{told}"


if __name__ == "__main__":
    studies.main(__file__, {"coverage": coverage})
