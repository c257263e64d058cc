"""What all tests of pages in a browser begin and end with."""


def ready(visit, path, **options):
    """Opens a page and waits until it says that it is ready."""
    seen = visit(path, **options)
    seen.page.wait_for_function("document.body.dataset.ready === 'true'", timeout=20_000)
    return seen


def quiet(seen, path):
    """Nothing was complained of, and nothing asked for from elsewhere."""
    assert seen.complaints == []
    assert seen.foreign_requests(path) == []
