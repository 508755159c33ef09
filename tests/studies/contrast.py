"""Do contrasts cover the truth, and how often do they find a difference where there is none?

contrast  ident/uncertainty/README.md; five minutes of one core

Synthetic studies with and without a difference, between people and paired; tests/studies/contrast_study.cc says what
varies.
"""
import studies

STUDY = ["--studies=100", "--num_threads=2"]


def contrast():
    found, told = studies.printed_table("pushid-contrast-study", *STUDY)
    rows = [[study, "**all**" if name == "all" else f"`{name}`", *cells] for study, name, *cells in found]
    header = ["study", "parameter", "intervals that hold the truth, %", "p < 0.05, %", "t-test on single fits: p < 0.05, %"]
    return f"{studies.table(header, rows)}\n\n{told}."


if __name__ == "__main__":
    studies.main(__file__, {"contrast": contrast})
