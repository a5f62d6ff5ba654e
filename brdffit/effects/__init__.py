"""Effects: what a scene calls for, decided before anything is traced."""

from brdffit.effects.decision import Decision as Decision
from brdffit.effects.plan import EFFECTS as EFFECTS, Plan as Plan, plan as plan
