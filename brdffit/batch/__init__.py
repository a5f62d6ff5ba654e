"""Folders of files and textures of texels: the same fits, many times, resumable.

A run is a list of small tasks. `cluster` hands them to threads or to a Dask scheduler,
`ledger` remembers which are finished, and `tally` tells how far a run is.
"""

from brdffit.batch.tally import Tally as Tally
