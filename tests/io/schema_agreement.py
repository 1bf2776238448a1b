"""Reads a JSON list of specs from standard input and prints, for each, 1 where the JSON Schema in the
file named by the first argument accepts it and 0 where it does not, as one line of digits."""
import json
import sys

try:
    import jsonschema
except ImportError:
    sys.exit(77)

with open(sys.argv[1], encoding="utf-8") as file:
    schema = json.load(file)
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
print("".join("1" if validator.is_valid(spec) else "0" for spec in json.load(sys.stdin)))
