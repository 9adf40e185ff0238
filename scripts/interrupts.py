"""Imported early by the scripts that draw: from then on an interrupt ends them by its signal, without a traceback."""

import signal

# A shell starts background jobs with SIGINT ignored; that stays so.
if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    signal.signal(signal.SIGINT, signal.SIG_DFL)
