"""What the commands print with `--json` against `doc/schema.json`: the tool is that of `DRIVELINE_TOOL`."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from jsonschema import Draft202012Validator

SCHEMA = json.loads((Path(__file__).parents[2] / "doc/schema.json").read_text())
TOOL = os.environ.get("DRIVELINE_TOOL")
TELEMETRY = Path(__file__).parents[2] / "host-tests/fuzz/corpus/telemetry/three_channels"


def closed(schema):
    """The schema without the keys to come that it leaves to a reader."""
    if isinstance(schema, list):
        return [closed(part) for part in schema]
    if not isinstance(schema, dict):
        return schema
    parts = {key: closed(part) for key, part in schema.items()}
    return {"additionalProperties": False, **parts} if isinstance(parts.get("required"), list) else parts


@unittest.skipUnless(TOOL, "DRIVELINE_TOOL names no tool")
class Schema(unittest.TestCase):
    def test_every_command_prints_what_its_schema_says(self):
        Draft202012Validator.check_schema(SCHEMA)
        with tempfile.TemporaryDirectory() as folder:
            def printed(command):
                ended = subprocess.run([TOOL, *command.split()], cwd=folder, capture_output=True, text=True)
                self.assertEqual(ended.returncode, 0, f"{command}: {ended.stderr}")
                return ended.stdout

            files = {name: made for name, made in SCHEMA["files"].items() if not name.startswith("$")}
            for name, made in files.items():
                Path(folder, name).write_text("\n".join(made) if isinstance(made, list) else printed(made))
            Path(folder, "telemetry.bin").write_bytes(TELEMETRY.read_bytes())
            commands = {name: part["title"] for name, part in SCHEMA["$defs"].items() if "title" in part}
            self.assertGreater(len(commands), 20)
            for name, command in commands.items():
                with self.subTest(command):
                    validator = Draft202012Validator(closed(SCHEMA | {"$ref": f"#/$defs/{name}"}))
                    found = json.loads(printed(f"{command} --json"))
                    faults = [f"{fault.json_path}: {fault.message[:200]}" for fault in validator.iter_errors(found)]
                    self.assertEqual(faults, [])
                    # it tells a fault
                    for key in SCHEMA["$defs"][name]["required"]:
                        self.assertFalse(validator.is_valid({k: v for k, v in found.items() if k != key}), key)
                    self.assertFalse(validator.is_valid(found | {"schema": 2}))
                    self.assertFalse(validator.is_valid(found | {"no key": 0}))


if __name__ == "__main__":
    unittest.main()
