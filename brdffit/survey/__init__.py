"""What a file of measured reflectance holds, before anything is fitted to it."""

from brdffit.survey.reciprocity import (
    Reciprocity as Reciprocity,
    reciprocity as reciprocity,
)
from brdffit.survey.summary import Summary as Summary, summary as summary
