"""Imported early by the scripts that draw: from then on an interrupt ends them by its signal, without a traceback."""

import contextlib
import os
import signal

# A shell starts background jobs with SIGINT ignored; that stays so.
if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@contextlib.contextmanager
def held_back():
    """A signal that would end the script within the block does so at its end."""
    came = []
    ending = [number for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
              if signal.getsignal(number) is signal.SIG_DFL]
    for number in ending:
        signal.signal(number, lambda number, frame: came.append(number))
    try:
        yield
    finally:
        for number in ending:
            signal.signal(number, signal.SIG_DFL)
        if came:
            os.kill(os.getpid(), came[0])
