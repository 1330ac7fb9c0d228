"""What the library leaves out is said first: on the front page, the first pages of the documentation, and in the help."""

import pytest
from conftest import REPOSITORY

import andoyer

SENTENCE = "The gravity of point masses acts on the body, and torques that you state: there is no drag and no control."


@pytest.mark.parametrize("page, before", [("README.md", "## Python"), ("docs/start.md", "## An answer"), ("docs/index.md", "## Where to begin")])
def test_page_says_first_which_torques_do_not_act(page, before):
    text = (REPOSITORY / page).read_text(encoding="utf-8")
    assert SENTENCE in text.split(before)[0]
    if page == "docs/index.md":
        assert "there is no drag and no control" in text.split("**Spacecraft.**")[1].split("::::")[0]


def test_help_of_scene_says_so_before_its_parameters():
    assert SENTENCE in " ".join(andoyer.Scene.__doc__.split("Parameters")[0].split())
