#pragma once

namespace bandvox::app {

/// From now on SIGINT, SIGTERM and SIGHUP ask the work to stop instead of ending the process.
/// Only the first one does: a second one removes the temporary files and ends the process at once.
/// A signal that the process was started to ignore stays ignored. A closed pipe is no signal any
/// more.
void installSignalHandlers();

/// The signal that has asked the work to stop, or 0.
int interruptSignal();

}  // namespace bandvox::app
