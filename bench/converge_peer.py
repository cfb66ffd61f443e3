"""A peer of converge.py in a process of its own: says who it is, and then does what it is told, a line each.

In come {"scene": ..., "size": ...} and {"samples": ..., "seed": ..., "picture": FILE}, out go the peer's version, {} and
{"seconds": ..., "cpu": ...}, as JSON; pictures as NumPy's files.
"""

import json
import os
import resource
import sys

import numpy


def cpu_seconds():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def serve(peer):
    # What libraries print goes elsewhere.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)

    def answer(what):
        print(json.dumps(what), file=answers, flush=True)

    answer({"version": peer.version()})
    for line in sys.stdin:
        told = json.loads(line)
        if "scene" in told:
            peer.prepare(told["scene"], told["size"])
            answer({})
        else:
            picture, seconds, cpu = peer.render(told["samples"], told["seed"])
            numpy.save(told["picture"], picture)
            answer({"seconds": seconds, "cpu": cpu})
