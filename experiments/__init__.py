"""One question per file; `python -m experiments.NAME` answers it in `results/NAME/`.

    stability          where does the textbook formula of a model fail, and does ours?
    million_pairs      is anything not finite among a million random pairs?
    original_phong     when does the original Phong model give wrong results?
    metal_highlight    how does a metal's highlight end, with Beckmann and with GGX?
    resamplings        how far do fits differ between two resamplings of one run?
    anisotropy         which way does a field of tangents stretch a highlight?

Beside the experiments stand what some of them share: `record` writes results,
`hard_cases` lists directions and parameters, `textbook` has the formulas as they are
printed, and `hard_cases_truth` makes the file of the same name with a hundred digits.
"""
