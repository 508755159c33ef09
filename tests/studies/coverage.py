"""How often 95 % intervals hold the truth where gains vary from recording to recording.

coverage  ident/uncertainty/README.md; 5 minutes on one core

32 synthetic recordings a data set; tests/studies/coverage_study.cc says what varies. The profile and bootstrap
intervals are those of the first data sets only, which is why they are known to a few per cent.
"""
import studies

UNBIASED = ["--datasets=400", "--refined=20", "--num_threads=1"]


def coverage():
    unbiased, told = studies.printed_table("pushid-coverage-study", *UNBIASED)
    rows = [[f"`{name}`", *cells[:4]] for name, *cells in unbiased]
    text = studies.table(["coverage of 95 % intervals, %", "clustered", "naive", "profile", "bootstrap"], rows)
    return f"{text}\n\n{told}"


if __name__ == "__main__":
    studies.main(__file__, {"coverage": coverage})
