"""One question per file; `python -m experiments.NAME` answers it in `results/NAME/`.

    stability          where does the textbook formula of a model fail, and does ours?
    million_pairs      is anything not finite among a million random pairs?
    original_phong     when does the original Phong model give wrong results?
    metal_highlight    what does the choice of Beckmann or GGX do to a metal's highlight?
    anisotropy         what do tangent fields do to the highlight on a sphere?

Beside the experiments stand what some of them share: `record` writes results,
`hard_cases` lists directions and parameters, `textbook` has the formulas as they are
printed, and `hard_cases_truth` makes the file of the same name with a hundred digits.
"""
