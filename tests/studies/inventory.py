"""How much of everything there is: lines and files of the product by feature, flags by program.

    python3 tests/studies/inventory.py            the two tables
    python3 tests/studies/inventory.py --check    fails where a feature has more than 5 % above its bound, a file has no
                                                  feature, or files or flags are too many; ctest runs it

The bound of a feature is what it had when it was last made smaller; the goal is what it should have. A change that takes
lines away lowers the bound, and no bound rises but by what another feature's files had that are in its own now. PUSHID_BIN: the programs that are asked for their flags.
"""
import os
import re
import subprocess
import sys

import studies

ENDINGS = (".h", ".cc", ".py", ".sh", ".json", ".cmake", ".toml", "CMakeLists.txt")
MOST_LINES, MOST_FILES, MOST_FLAGS, MOST_FIT_FLAGS, SLACK = 70007, 350, 160, 45, 1.05
# Feature, goal, bound, and the files of it: the first row that matches a file has it.
FEATURES = [
    ("contrasts", 560, 601, r"ident/(fit/(covariates|contrast)|uncertainty/contrast|report/contrast)"),
    ("verdict", 1000, 889, r"ident/uncertainty/(model_verdict|assumptions)"),
    ("steps and stance", 1749, 1423, r"models/(stance|standing|support)|datasets/loading/foot_steps|ident/(fit/step_probability|prediction/predicted_steps|report/page/standing)"),
    ("laboratory", 1648, 1426, r"models/(ground|reaction_delay|turn)|datasets/(loading/(laboratory|ground_markers)|manifest/laboratory_keys)|residuals/plate_residual|ident/(parameters/laboratory|fit/laboratory|prediction/laboratory)"),
    ("interaction", 450, 474, r"models/(contact|pair|interaction|ldp_interaction|neighbours)"),
    ("learned terms", 1200, 423, r"models/(learned_terms|self_network)|ident/parameters/(learned_terms|self_network)|residuals/takeover"),
    ("large networks", 1295, 1212, r"ident/(large_networks|solver/network_training)|residuals/adjoint/(adjoint_gradient|step)"),
    ("derivatives, lanes, kernels", 2300, 2582, r"models/jet|residuals/(kernels|lanes|jets|adjoint|autodiff_force_law|normal_equations|cost_functions/condensed)"),
    ("noise, likelihoods, paths", 1600, 1364, r"models/(process_noise|input_|pendulum_filter)|residuals/cost_functions/likelihood|ident/(solver/likelihood|forecasts/(most_probable|path))|apps/pushid_path"),
    ("diffusion", 1500, 1503, r"models/generators/diffusion|apps/flags/.*diffusion"),
    ("particles", 2400, 1996, r"models/(particles|generators/particle)|ident/forecasts/forecast_"),
    ("generators' files, training, programs", 1600, 1915, r"models/generators|ident/(generators|training/generator)|apps/(generate|pushid_generate|pushid_train_generator|flags/(generate|train_generator|training|published))"),
    ("group metrics", 1400, 1216, r"ident/(validation/(group_|hip_group)|forecasts/social|diagnostics/social)|models/restoration/(group_motion|state_classifier|social)"),
    ("restoration", 3500, 3796, r"models/restoration|ident/(training|bodies/restoration_files)|apps/(pushid_train_restoration|flags/(.*restoration|postprocess|body))"),
    ("bodies, animation", 2000, 1593, r"ident/bodies|apps/pushid_animate"),
    ("first frames", 1300, 958, r"ident/(observed|forecasts|prediction/online|report/page/forecast)|apps/flags/(futures|observed)"),
    ("formations", 1600, 1471, r"ident/formations|models/crowd|apps/(formation|pushid_formation|flags/formation)"),
    ("pushes", 2000, 1920, r"models/push|ident/(push/|model/push_range)|datasets/(sensors|formats/(push_csv|force_csv))|apps/(pushid_push|flags/push)"),
    ("design", 260, 259, r"ident/(validation/(experiment_design|study_plan|laboratory_plan|design)|report/design)"),
    ("prediction, evaluation, cross-validation", 2700, 3890, r"ident/(prediction|validation)|apps/pushid_(predict|evaluate|crossvalidate)|apps/flags/scheme"),
    ("loop and frequency", 800, 330, r"ident/(diagnostics/(frequency|loop|spectra|sway)|problem/linear_loop|report/loop|figures/bode)"),
    ("uncertainty", 3200, 3476, r"ident/(uncertainty|problem/residual_rows|checks|fit/interval)|apps/(pushid_check|flags/check)"),
    ("reports", 2800, 3335, r"ident/(report|figures/text_table)|apps/pushid_report"),
    ("charts", 1000, 826, r"ident/figures"),
    ("exchange", 350, 361, r"datasets/(exchange|formats/(trajector|motion_bids))|apps/pushid_export"),
    ("formats", 3900, 3939, r"datasets/(formats|files/(numeric_table|input_file|number_text|names|atomic|error|npy|random))"),
    ("JSON, schemas", 1000, 1529, r"datasets/files|apps/schemas|ident/(parameters/json|model/.*(json|fields))"),
    ("manifest and loading", 3300, 4133, r"datasets/(manifest|loading)"),
    ("inspection", 1700, 2371, r"datasets/inspection|apps/pushid_(inspect|manifest)"),
    ("synthetic", 900, 751, r"datasets/synthetic|apps/pushid_simulate"),
    ("batches", 1500, 1467, r"apps/(batch|pushid_batch|workflow)"),
    ("Python", 2600, 2631, r"apps/python"),
    ("packaging, site", 500, 448, r"apps/(packaging|site|explore|quickstart|laboratory|mkdocs)|(models|residuals|datasets|ident|apps)/CMakeLists.txt"),
    ("flags", 900, 1600, r"apps/(flags|support|pushid\.cc|completion)"),
    ("fit, options, solver", 5500, 8024, r"ident/(fit|model|parameters|problem|solver|diagnostics|pushid\.h)|apps/pushid_fit"),
    ("core model", 3200, 3875, r"models|residuals"),
]


def sources():
    for room in ("models", "residuals", "datasets", "ident", "apps"):
        for folder, folders, names in os.walk(os.path.join(studies.SOURCE, room)):
            folders.sort()
            for name in sorted(names):
                if name.endswith(ENDINGS):
                    yield os.path.relpath(os.path.join(folder, name), studies.SOURCE)


def lines(path):
    with open(os.path.join(studies.SOURCE, path), encoding="utf-8") as file:
        return sum(1 for _ in file)


def by_feature():
    """Feature -> files; files of no feature under ""."""
    found = {name: [] for name, *_ in FEATURES} | {"": []}
    for path in sources():
        found[next((name for name, _, _, pattern in FEATURES if re.match(pattern, path)), "")].append(path)
    return found


def flags():
    """Program -> its flags by --help=all, without those that every program has."""
    programs = sorted(name for name in os.listdir(studies.BIN) if re.match(r"pushid-(?!benchmarks|.*study)", name))
    own = {}
    for name in programs:
        text = subprocess.run([os.path.join(studies.BIN, name), "--help=all"], capture_output=True, text=True).stdout
        own[name] = set(re.findall(r"^ *--(\w+)", text, re.M))
    shared = set.intersection(*own.values()) if own else set()
    return {name: found - shared for name, found in own.items()}, shared


def main():
    found = by_feature()
    counted = {name: sum(map(lines, files)) for name, files in found.items()}
    all_lines = sum(counted.values())
    rows = [[name, len(found[name]), counted[name], bound, goal] for name, goal, bound, _ in FEATURES]
    rows.append(["**all**", sum(map(len, found.values())), all_lines, MOST_LINES, sum(goal for _, goal, *_ in FEATURES)])
    print(studies.table(["feature", "files", "lines", "bound", "goal"], rows) + "\n")
    wrong = [f"{path}: of no feature in {os.path.basename(__file__)}" for path in found[""]]
    wrong += [f"{name}: {counted[name]} lines, more than 5 % above {bound}" for name, _, bound, _ in FEATURES
              if counted[name] > SLACK * bound]
    counts = [("lines", all_lines, MOST_LINES), ("C++ files", sum(p.endswith((".h", ".cc")) for p in sum(found.values(), [])), MOST_FILES)]
    if os.path.isdir(studies.BIN):
        own, shared = flags()
        print(studies.table(["program", "flags"], [[name, len(names)] for name, names in own.items()]))
        print(f"\n{len(set.union(shared, *own.values()))} different flags, {len(shared)} of them of every program\n")
        counts += [("flags", len(set.union(shared, *own.values())), MOST_FLAGS),
                   ("flags of pushid-fit", len(own.get("pushid-fit", ())), MOST_FIT_FLAGS)]
    for what, number, most in counts:
        print(f"{what}: {number}, at most {most}")
        if number > most:
            wrong.append(f"{what}: {number}, at most {most}")
    if "--check" in sys.argv[1:]:
        sys.exit("\n".join(wrong) or None)


if __name__ == "__main__":
    main()
