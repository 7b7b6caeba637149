/* A recorded run through the C interface: a record in, a tick, a record out with its instructions. */
#include "hoist.h"
#include "run.h"

/* As the words of a scene's input. */
typedef struct {
    uint32_t angle;
    hoist_number torque, setpoint;
    uint32_t flags, others[4];
} input;

/* What a tick gives, and takes. */
typedef struct {
    hoist_number torque;
    hoist_estimates estimates;
    uint32_t code, instructions;
    /* more than the drive called from Rust */
    uint32_t more;
} output;

static hoist_drive drive;

#ifdef BESIDE
/* The drive called from Rust without the C interface, in the same image. */
uint32_t rust_state[64];
void rust_new(uint32_t *state);
void rust_hold(uint32_t *state, uint32_t angle, const hoist_number *torque);
uint32_t rust_tick(uint32_t *state, const hoist_sample *sample, hoist_number *torque);
#endif

int run(void)
{
    input in;
    if (hoist_init(&drive, 0) != 0) return 1;
#ifdef BESIDE
    rust_new(rust_state);
#endif
    while (receive(&in, sizeof in)) {
        static output out;
        out.instructions = out.more = 0;
        const hoist_sample sample = { in.angle, in.torque, in.setpoint };
        if (in.flags & 1) {
            uint32_t before = count();
            out.code = hoist_tick(&drive, &sample, &out.torque);
            out.instructions = instructions(count() - before);
        } else {
            out.code = hoist_hold(&drive, in.angle, in.setpoint, &out.torque);
        }
#ifdef BESIDE
        if (in.flags & 1) {
            hoist_number torque;
            uint32_t before = count();
            uint32_t code = rust_tick(rust_state, &sample, &torque);
            uint32_t taken = instructions(count() - before);
            if (code != out.code || torque != out.torque) return 1;
            out.more = out.instructions - taken;
        } else {
            rust_hold(rust_state, in.angle, &in.setpoint);
        }
#endif
        if (hoist_estimate(&drive, &out.estimates) != 0) return 1;
        if (!send(&out, sizeof out)) return 1;
    }
    return 0;
}
