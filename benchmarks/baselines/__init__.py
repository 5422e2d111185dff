"""The same network as a user would write it without lobula, and the flow a user would take instead."""
