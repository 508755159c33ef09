"""Do default fits recover truths that nobody put beside the priors?

truths  ident/README.md; half a minute on two cores
groups  ident/README.md; rows whose feet step, of people who are alike and who differ by 10 %; 7 minutes on two cores

Synthetic studies of their own truths; tests/studies/known_truth_study.cc says what varies.
"""
import studies

STUDY = ["--studies=200", "--num_threads=2"]
GROUPS = ["--groups", "--studies=12", "--num_threads=2"]


def truths():
    return table_of(STUDY)


def groups():
    return "\n\n".join(table_of([*GROUPS, f"--people_spread={spread}"]) for spread in (0, 0.1))


def table_of(arguments):
    spread, told = studies.printed_table("pushid-known-truth-study", *arguments)
    header = ["how many, and % of the intervals that hold the truth", "identified", "model-dependent", "weak", "prior-held",
              "unidentifiable", "at bound"]
    rows = [[f"`{row[0]}`" if row[0] != "all" else "**all**", *row[1:]] for row in spread]
    return f"{studies.table(header, rows)}\n\n{told}."


if __name__ == "__main__":
    studies.main(__file__, {"truths": truths, "groups": groups})
