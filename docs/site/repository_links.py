"""Links to files of the repository that are no pages: checked, and shown as their path.

The site works without the repository, so a link to a header, an example or a scene becomes the path
in it. One that leads nowhere is a warning, which the build takes as an error.
"""

import os
import pathlib

from docutils import nodes
from sphinx.transforms import SphinxTransform
from sphinx.util import logging

ROOT = pathlib.Path(__file__).resolve().parents[2]
logger = logging.getLogger(__name__)


class RepositoryLinks(SphinxTransform):
    default_priority = 5  # before MyST resolves its own

    def apply(self):
        folder = os.path.dirname(self.env.docname)
        for node in list(self.document.findall(lambda n: isinstance(n, (nodes.reference, nodes.Element))
                                               and n.get("reftype") == "myst"
                                               or n.tagname == "download_reference")):
            target = node.get("reftarget", "")
            path, _, _ = target.partition("#")
            place = os.path.normpath(os.path.join(folder, path.lstrip("/")))
            if node.get("refdomain") == "doc" or not path or "://" in path:
                continue  # MyST checks links to pages itself
            if not (ROOT / place).exists():
                logger.warning("'%s' is neither a page nor in the repository", target, location=node)
            text = node.astext()
            if place not in text:
                text = f"{text} ({place})"
            node.replace_self(nodes.literal(text, text))


def setup(app):
    app.add_transform(RepositoryLinks)
    return {"parallel_read_safe": True}
