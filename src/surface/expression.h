/* expression.h - formulas of the user's own: an expression in u and v as a program for a machine with a stack, run with
   exact first and second derivatives (second-order dual numbers), over one sample or many (expression_body.h).

     numbers, u, v, pi;  + - * / ^, parentheses;  sqrt sin cos exp log abs (x),  pow atan2 min max (x, y); angles in radians
     ^ binds before the sign and from the right: -2^2 = -4, 2^3^2 = 512 */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;

#define WR_PROGRAM_OPS 600     /* of the three expressions together */
#define WR_PROGRAM_STACK 24    /* values that wait, besides the results */
#define WR_EXPRESSION_DEPTH 50 /* parentheses, signs and powers within each other */
#define WR_POWER_WHOLE 32      /* whole powers up to this are multiplied out */

typedef enum WrOpCode {
    WR_OP_CONST,
    WR_OP_U,
    WR_OP_V,
    WR_OP_ADD,
    WR_OP_SUB,
    WR_OP_MUL,
    WR_OP_DIV,
    WR_OP_NEG,
    WR_OP_SQRT,
    WR_OP_SIN,
    WR_OP_COS,
    WR_OP_EXP,
    WR_OP_LOG,
    WR_OP_ABS,
    WR_OP_WHOLE, /* x to the power `value`, whole */
    WR_OP_POWER, /* x to the power `value` */
    WR_OP_POW,
    WR_OP_ATAN2,
    WR_OP_MIN,
    WR_OP_MAX,
    WR_OP_COUNT
} WrOpCode;

typedef struct WrOp {
    WrOpCode code;
    int column;   /* in its text, from 1 */
    double value; /* CONST, WHOLE, POWER */
} WrOp;

/* Expressions one after the other: each leaves one value more on the stack. */
typedef struct WrProgram {
    int count;
    WrOp op[WR_PROGRAM_OPS];
} WrProgram;

/* Append an expression. Errors: "NAME: column 7: ..."; the program is then of no use. */
bool wr_expression_read(const char *name, const char *text, WrProgram *program, WrError *err);

/* How many values an operation takes from the stack. */
int wr_op_takes(WrOpCode code);
