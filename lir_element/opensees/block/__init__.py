"""The memory of a bearing in a foreign model."""
