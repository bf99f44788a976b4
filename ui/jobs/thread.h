/* thread.h - threads of the window, where the system may refuse one: what they were for is then done in place. */
#pragma once
#include "system/thread.h"

#include <stdbool.h>

/* Start it; false, and remembered, if the system gives none. */
bool wr_thread_start(WrThread *thread, void *(*run)(void *), void *arg);
/* Has the system refused one? True once: there is one message about it. */
bool wr_thread_refused(void);
