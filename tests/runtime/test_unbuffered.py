"""Text goes to the file itself, all of it; what is no file stays what it is."""

from __future__ import annotations

import io
import os
import threading

from lobula.runtime.unbuffered import unbuffered


def test_more_than_a_pipe_holds_goes_through_it():
    read, write = os.pipe()
    text = "".join(f"{number} Grüße\n" for number in range(50_000))
    with os.fdopen(write, "w", encoding="utf-8") as stream, os.fdopen(read, encoding="utf-8") as reader:
        found = []
        thread = threading.Thread(target=lambda: found.append(reader.read()))
        thread.start()
        stream.write("before\n")  # what waits in the buffer comes first
        assert unbuffered(stream).write(text) == len(text)
        stream.close()
        thread.join(30)
    assert found == ["before\n" + text]


def test_what_is_no_file_is_returned():
    stream = io.StringIO()
    assert unbuffered(stream) is stream
