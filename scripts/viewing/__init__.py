"""A run as one HTML page. `fields` knows what frames hold, `shapes` where bodies are, `packing` writes both as text,
`page` puts the page together; viewer.html.j2, viewer.css and the scripts are its parts."""
