/* A run on the host: the files `input` and `output`, no counter. Before it, every wrong call. */
#include <stdio.h>
#include <string.h>

#include "hoist.h"
#include "run.h"

static FILE *in, *out;

int receive(void *bytes, size_t size) { return fread(bytes, size, 1, in) == 1; }
int send(const void *bytes, size_t size) { return fwrite(bytes, size, 1, out) == 1; }
uint32_t count(void) { return 0; }
uint32_t instructions(uint32_t counts) { return counts; }

/* Every refused call returns its code and leaves state and results as they were, whatever fills the memory. */
static int wrong_calls(int filled)
{
    hoist_drive drive, before;
    hoist_number torque = 7;
    hoist_estimates estimates, kept;
    const hoist_sample sample = { 0, 0, 0 };
    memset(&drive, filled, sizeof drive);
    memset(&estimates, 0x3c, sizeof estimates);
    before = drive;
    kept = estimates;
    const uint32_t refused[] = {
        hoist_tick(&drive, &sample, &torque),       hoist_coast(&drive, 0, 0, &torque),
        hoist_hold(&drive, 0, 0, &torque),          hoist_make_up(&drive, 0, 1),
        hoist_engage(&drive),                       hoist_estimate(&drive, &estimates),
        hoist_tick_after(&drive, &sample, 1, &torque),
    };
    for (size_t call = 0; call < sizeof refused / sizeof *refused; call++) {
        if (refused[call] != HOIST_REFUSED_NOT_INITIALISED) return 1;
    }
    if (hoist_init_checked(&drive, sizeof drive - 4, HOIST_HEADER, 0) != HOIST_REFUSED_SIZE) return 2;
    if (hoist_init_checked(&drive, sizeof drive + 4, HOIST_HEADER, 0) != HOIST_REFUSED_SIZE) return 3;
    if (hoist_init_checked(&drive, sizeof drive, HOIST_HEADER + 1, 0) != HOIST_REFUSED_HEADER) return 4;
    if (memcmp(&drive, &before, sizeof drive) || memcmp(&estimates, &kept, sizeof kept) || torque != 7) return 5;

    /* a value that is no number is flagged and left out: the next tick is as if it had not been */
    const float nan = 0.0f / (float)(hoist_init(&drive, 0) * 0u);
    const hoist_sample bad = { 0, hoist_from_torque(nan), hoist_from_speed(nan) };
    uint32_t code = hoist_tick(&drive, &bad, &torque);
    if (code != (HOIST_FAULT_TORQUE | HOIST_FAULT_SETPOINT) || torque != 0) return 6;
    if (hoist_tick(&drive, &sample, &torque) != 0 || torque != 0) return 7;
    if (hoist_hold(&drive, 0, hoist_from_torque(nan), &torque) != HOIST_FAULT_SETPOINT || torque != 0) return 8;
    if (hoist_coast(&drive, hoist_from_torque(nan), 0, &torque) != (HOIST_FAULT_TORQUE | HOIST_FAULT_ANGLE_MISSING))
        return 9;

    /* a text is cut off with its zero, and nothing after it is written */
    char text[16];
    memset(text, '#', sizeof text);
    if (hoist_fault_text(HOIST_FAULT_TORQUE | HOIST_FAULT_SETPOINT, text, 10) != strlen("torque, setpoint")) return 10;
    if (memcmp(text, "torque, s\0######", 16)) return 11;
    if (hoist_fault_text(0, text, sizeof text) != 4 || strcmp(text, "none")) return 12;
    if (hoist_fault_text(HOIST_REFUSED_SIZE, NULL, 0) != strlen("wrong size of the state")) return 13;
    return 0;
}

/* Ticks that did not run, by their count: those of `TickCount`'s example, made up and flagged. */
static int missed_ticks(void)
{
    static const uint16_t counts[] = { 65534, 65535, 0, 3, 3, 4 };
    static const uint32_t expected[] = { 0, 0, 0, 2, 0, 0 };
    uint16_t next = counts[0];
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        if (hoist_missed(&next, counts[k]) != expected[k]) return 20;
    }
    hoist_drive one, other;
    hoist_number torque, others;
    const hoist_sample sample = { 1u << 20, 0, hoist_from_speed(50.0f) };
    hoist_init(&one, 0);
    other = one;
    if (hoist_tick_after(&one, &sample, 2, &torque) != HOIST_FAULT_TICK_MISSED) return 21;
    if (hoist_make_up(&other, 0, 2) != HOIST_FAULT_TICK_MISSED || hoist_tick(&other, &sample, &others) != 0) return 22;
    if (memcmp(&one, &other, sizeof one) || torque != others || torque == 0) return 23;
    /* of more than are made up the angle is taken over */
    if (hoist_tick_after(&one, &sample, 40, &torque) != (HOIST_FAULT_TICK_MISSED | HOIST_FAULT_ANGLE_MISSING)) return 24;
    return 0;
}

int main(void)
{
    int wrong = missed_ticks();
    for (int filled = 0; filled < 256 && !wrong; filled++) wrong = wrong_calls(filled);
    if (wrong) {
        fprintf(stderr, "wrong call %d\n", wrong);
        return 1;
    }
    in = fopen("input", "rb");
    out = fopen("output", "wb");
    if (!in || !out) return 1;
    int result = run();
    return fclose(out) || fclose(in) || result;
}
