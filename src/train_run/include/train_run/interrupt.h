#pragma once

namespace train_run {

/// Makes Ctrl-C, SIGTERM and the end of a terminal ask for a clean end, once; a second one ends the process as usual.
void CatchInterrupts();

/// The signal that asked for an end, 0 as long as none has.
int Interrupt();

}  // namespace train_run
