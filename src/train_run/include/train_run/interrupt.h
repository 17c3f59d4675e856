#pragma once

namespace train_run {

/// Makes the first Ctrl-C, SIGTERM or SIGHUP request a clean end; the second one ends the process as usual.
void CatchInterrupts();

/// The signal that requested an end; 0: none so far.
int Interrupt();

}  // namespace train_run
