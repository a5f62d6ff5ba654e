"""One question per file; `python -m experiments.NAME` answers it in `results/NAME/`.

What accuracy costs in time:

    forward_models     what do approximations inside models cost, and what do they save?
    fit_budget         what do pixels, samples, starts and digits buy in a fit?
    solvers            which solver comes close first, from one start on the same data?
    six_materials      how do six materials look in one lit scene, and at what price?
    effect_cost        what does each effect of a scene change, and what does it take?
    model_cost         which model leaves how much error on measurements, and how fast?
    shadow_maps        how do shadow maps come closer to the exact shadow?
    probe_directions   how many directions does a light probe take, per roughness?
    bounce_depth       how deep must mirrors and glass be followed, at what price?

Models and what they describe:

    introduction       what does a fit of the bundled examples look like?
    model_comparison   which model explains which material, under which residual?
    merl_ranking       which models fit stand-ins for MERL materials best, and how fast?
    curet_matte        how much does a rough model gain over Lambert's on matte samples?
    ptfe               which model describes a white standard better than Lambert's?
    ball_gloss         how many lobes does the gloss of a photographed ball take?
    ball_texture       what do twelve photographs of a ball tell about each texel?
    original_phong     when does the original Phong model give wrong results?
    metal_highlight    how does a metal's highlight end, with Beckmann and with GGX?
    anisotropy         which way does a field of tangents stretch a highlight?
    catalogue          how does a sphere of each model look?
    classic_scenes     what do the classic scenes of ray tracing look like?

Whether the numbers can be trusted:

    stability          where does the textbook formula of a model fail, and does ours?
    million_pairs      is anything not finite among a million random pairs?
    recovery           does a fit find the truth again, for every model?
    coverage           does a 95 % interval hold the truth in 95 % of all repetitions?
    many_starts        what do many starts gain on hard cases, and what do they cost?
    hostile_input      does a damaged or lying file bring a reader down?
    resamplings        how far do fits differ between two resamplings of one run?

`python -m experiments` runs them all, each in a process of its own, and rebuilds the
gallery, `results/README.md`; an experiment that takes long runs at a reduced size then,
and at full size by `python -m experiments.NAME --full`.

Beside the experiments stand what some of them share: `record` writes results,
`tradeoff` measures error against time, `pareto` draws it, `labels` finds places for
names, `measured_sets` and `comparison_sets` are materials, `comparison_figures` draws
three models on them, `gallery` makes the page, `captions` says what tables show,
`hard_cases` lists directions and parameters, `textbook` has the formulas as they are
printed, `hard_cases_truth` makes the file of the same name with a hundred digits, and
`merl_standins` makes materials for MERL files.
"""
