/* thread.h - threads of the window, with a fallback: if the system refuses one, the caller does the work itself. */
#pragma once
#include "system/thread.h"

#include <stdbool.h>

/* Start a thread; false, and recorded, if the system refuses one. */
bool wr_thread_start(WrThread *thread, void *(*run)(void *), void *arg);
/* True once after the system has refused a thread, for a single message. */
bool wr_thread_refused(void);
