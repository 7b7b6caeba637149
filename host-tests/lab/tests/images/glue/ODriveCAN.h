// As much of ODriveArduino's interface (CAN) as the book's glue calls.
#pragma once
#include <cstdint>
enum ODriveControlMode { CONTROL_MODE_TORQUE_CONTROL = 1 };
enum ODriveInputMode { INPUT_MODE_PASSTHROUGH = 1 };
struct Get_Encoder_Estimates_msg_t {
    float Pos_Estimate = 0.0f; // turns
    float Vel_Estimate = 0.0f;
};
class ODriveCAN {
public:
    bool setControllerMode(std::uint8_t control_mode, std::uint8_t input_mode) { return control_mode == input_mode; }
    bool setTorque(float torque) { return torque == torque; } // N m
};
