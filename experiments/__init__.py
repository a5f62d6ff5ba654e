"""One question per file; `python -m experiments.NAME` answers it in `results/NAME/`.

    stability          where does the textbook formula of a model fail, and does ours?
    million_pairs      is anything not finite among a million random pairs?
    original_phong     when does the original Phong model give wrong results?
    metal_highlight    how does a metal's highlight end, with Beckmann and with GGX?
    resamplings        how far do fits differ between two resamplings of one run?
    six_materials      how do six materials look in one lit scene, and at what price?
    shadow_maps        how do shadow maps come closer to the exact shadow?
    probe_directions   how many directions does a light probe take, per roughness?
    classic_scenes     what do the classic scenes of ray tracing look like?
    anisotropy         which way does a field of tangents stretch a highlight?
    merl_ranking       which models fit stand-ins for MERL materials best, and how fast?
    curet_matte        how much does a rough model gain over Lambert's on matte samples?
    ptfe               which model describes a white standard better than Lambert's?
    hostile_input      does a damaged or lying file bring a reader down?
    ball_gloss         how many lobes does the gloss of a photographed ball take?

Beside the experiments stand what some of them share: `record` writes results,
`hard_cases` lists directions and parameters, `textbook` has the formulas as they are
printed, `hard_cases_truth` makes the file of the same name with a hundred digits, and
`merl_standins` makes materials for MERL files.
"""
