import jax
import pytest

from brdffit.compiled import make_room

jax.config.update("jax_numpy_rank_promotion", "raise")


@pytest.fixture(autouse=True, scope="module")
def _programs_do_not_pile_up():
    yield
    make_room()


@pytest.fixture
def key():
    return jax.random.key(0)
