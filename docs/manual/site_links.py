"""Links of pages that are read on a code host, too: a folder of the repository has no page of its own here."""

import pathlib

from docutils import nodes
from sphinx import addnodes
from sphinx.transforms.post_transforms import SphinxPostTransform


class FoldersAreNamedOnly(SphinxPostTransform):
    """Leaves of a link to a folder its words. Before MyST looks for its target."""

    default_priority = 5

    def run(self, **options):
        for link in list(self.document.findall(addnodes.pending_xref)):
            if link.get("reftype") != "myst":
                continue
            page = pathlib.Path(self.env.doc2path(self.env.docname))
            if (page.parent / link["reftarget"]).is_dir():
                words = nodes.inline(classes=["folder"])
                words += link.children
                link.replace_self(words)


def setup(app):
    app.add_post_transform(FoldersAreNamedOnly)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
