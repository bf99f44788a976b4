/* doc.h - documents of the C interface, as the program's own subcommands create them. Private to this program: not
   installed. */
#pragma once
#include "api/wrinkle.h"

typedef struct WrError WrError;
typedef struct WrSession WrSession;
typedef struct WrSessionOptions WrSessionOptions;

/* Creates a document with these options, which keep the caller's pool and notes. Its work reports to the thread's progress
   (base/progress.h). NULL and an error: an instruction set that this processor lacks. */
WrDoc *wr_api_new(const WrSessionOptions *options, WrError *err);
/* Error if this processor lacks the instruction set; NULL is fine. */
bool wr_api_check_instruction_set(const char *isa, WrError *err);
/* The document's session. Borrowed. */
WrSession *wr_api_session(WrDoc *doc);
